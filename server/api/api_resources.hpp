// What the endpoints share: caches. Lives as long as the server. Thread: any.
#pragma once

#include "server/api/hierarchy_cache.hpp"

namespace stipple::server {

struct ApiLimits {
    std::uint64_t hierarchyCacheBytes = 256ull << 20;
};

struct ApiResources {
    explicit ApiResources(const ApiLimits& chosen = {})
        : limits(chosen), hierarchy(chosen.hierarchyCacheBytes) {}

    const ApiLimits limits;
    HierarchyCache hierarchy;
};

} // namespace stipple::server
