// What the endpoints share: limits, caches, room on disk. Lives as long as the server. Thread: any.
#pragma once

#include "server/api/hierarchy_cache.hpp"
#include "server/files/scratch_space.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace stipple::server {

// Of one answer of points.
struct PointLimits {
    std::uint64_t maxPoints = 100'000'000;
    std::uint64_t maxBytes = 8ull << 30; // of its body
    int threads = 1;                     // that decode and encode; jobs of several clients run side by side
};

struct ApiLimits {
    std::uint64_t hierarchyCacheBytes = 256ull << 20;
    PointLimits points = {};
    std::string scratchFolder = {};           // for answers made as files (LAZ); empty: the system's
    std::uint64_t scratchBytes = 16ull << 30; // of all of them at once
};

struct ApiResources {
    explicit ApiResources(const ApiLimits& chosen = {})
        : limits(chosen), hierarchy(chosen.hierarchyCacheBytes),
          scratch(std::make_shared<ScratchSpace>(folderOf(chosen), chosen.scratchBytes)) {}

    const ApiLimits limits;
    HierarchyCache hierarchy;
    const std::shared_ptr<ScratchSpace> scratch;

  private:
    static std::string folderOf(const ApiLimits& limits) {
        std::error_code none;
        return limits.scratchFolder.empty() ? std::filesystem::temp_directory_path(none).string()
                                            : limits.scratchFolder;
    }
};

} // namespace stipple::server
