// What the endpoints share: limits, caches, room on disk, and what draws pictures. Lives as long as the
// server. Thread: any.
#pragma once

#include "server/api/hierarchy_cache.hpp"
#include "server/cache/shared_cache.hpp"
#include "server/files/scratch_space.hpp"
#include "server/http/client_rate.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace stipple::server {

class PictureService;

// Of one answer of points.
struct PointLimits {
    std::uint64_t maxPoints = 100'000'000;
    std::uint64_t maxBytes = 8ull << 30; // of its body
    int threads = 1;                     // that decode and encode; jobs of several clients run side by side
};

struct ApiLimits {
    std::uint64_t hierarchyCacheBytes = 256ull << 20;
    std::uint64_t statisticsBytes = 16ull << 20; // of answers that are kept; one has a few thousand
    PointLimits points = {};
    std::string scratchFolder = {};           // for answers made as files (LAZ); empty: the system's
    std::uint64_t scratchBytes = 16ull << 30; // of all of them at once
    double picturesPerMinute = 60;            // drawn for one client; kept ones do not count. 0: any number
};

class ApiResources {
  public:
    explicit ApiResources(const ApiLimits& chosen = {});
    ~ApiResources();

    const ApiLimits limits;
    HierarchyCache hierarchy;
    SharedCache<std::string, std::string> statistics; // documents, by keptKeyOf()
    const std::shared_ptr<ScratchSpace> scratch;
    PictureService& pictures() const { return *pictures_; }
    const std::shared_ptr<ClientRate> pictureRate;

  private:
    std::unique_ptr<PictureService> pictures_;
};

} // namespace stipple::server
