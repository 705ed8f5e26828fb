#include "server/api/api_resources.hpp"

#include "server/api/picture_service.hpp"

#include <filesystem>

namespace stipple::server {

namespace {

std::string folderOf(const ApiLimits& limits) {
    std::error_code none;
    return limits.scratchFolder.empty() ? std::filesystem::temp_directory_path(none).string()
                                        : limits.scratchFolder;
}

} // namespace

ApiResources::ApiResources(const ApiLimits& chosen)
    : limits(chosen), hierarchy(chosen.hierarchyCacheBytes), statistics(chosen.statisticsBytes),
      scratch(std::make_shared<ScratchSpace>(folderOf(chosen), chosen.scratchBytes)),
      pictureRate(std::make_shared<ClientRate>(chosen.picturesPerMinute)),
      pictures_(std::make_unique<PictureService>()) {}

ApiResources::~ApiResources() = default;

} // namespace stipple::server
