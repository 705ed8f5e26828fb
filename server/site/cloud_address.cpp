#include "server/site/cloud_address.hpp"

#include "shared/base/text.hpp"

namespace stipple::server {

namespace {

constexpr std::string_view fileSuffix = ".stipple";

bool isBelowClouds(const Target& target) {
    const auto& path = target.segments;
    return path.size() >= 3 && path[0] == "api" && path[1] == "v1" && path[2] == "clouds";
}

} // namespace

std::string cloudAddress(const std::string& id) {
    return cat("/clouds/", percentEncoded(id), fileSuffix);
}

std::optional<std::string> cloudIdOf(const Target& target) {
    const auto& path = target.segments;
    if (isBelowClouds(target) && path.size() >= 4)
        return path[3];
    if (path.size() != 2 || path[0] != "clouds" || !path[1].ends_with(fileSuffix))
        return std::nullopt;
    return path[1].substr(0, path[1].size() - fileSuffix.size());
}

bool isCloudList(const Target& target) {
    return isBelowClouds(target) && target.segments.size() == 3;
}

} // namespace stipple::server
