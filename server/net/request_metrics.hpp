// Counts what was answered, on one event loop; the loops' counts are added up when somebody asks. Internal to
// server/net.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace stipple::server {

// By the first part of the target. `invalid`: what was no request.
enum class Route { page, cloudFile, api, operations, invalid };
inline constexpr std::size_t routeCount = 5;
const char* routeName(Route route);
Route routeOf(std::string_view target);
// The cloud's id in the target of a cloud's file or of something of the API; nothing in any other.
std::optional<std::string_view> cloudOf(std::string_view target);

struct RequestTotals {
    static constexpr std::array<double, 15> secondsBounds{
        0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0};
    // More clouds than this are counted together, under otherClouds: their number is what a scraper stores.
    static constexpr std::size_t maxClouds = 256;
    static constexpr const char* otherClouds = "(other)"; // no id has parentheses

    struct OfRoute {
        std::array<std::uint64_t, 6> byStatusClass{}; // [2]: 2xx
        std::uint64_t bodyBytes = 0, count = 0;
        std::array<std::uint64_t, secondsBounds.size() + 1> bySeconds{}; // the last: longer than every bound
        double seconds = 0;
    };
    struct OfCloud {
        std::uint64_t requests = 0, bodyBytes = 0;
    };
    std::array<OfRoute, routeCount> routes;
    std::map<std::string, OfCloud, std::less<>> clouds;
    std::uint64_t cut = 0; // answers that did not reach their end
    int inFlight = 0;

    OfCloud& ofCloud(std::string_view id);
    void add(const RequestTotals& other);
};

class RequestMetrics {
  public:
    struct Sample {
        std::string_view target; // empty: what came was no request
        int status = 0;
        std::uint64_t bodyBytes = 0;
        double seconds = 0;
        bool isComplete = true;
    };
    // Thread: the loop's.
    void began() { inFlight_.fetch_add(1, std::memory_order_relaxed); }
    void ended(const Sample& sample);
    // Thread: any.
    RequestTotals totals() const;

  private:
    std::atomic<int> inFlight_{0};
    mutable std::mutex mutex_; // nearly always free: the only other taker is who asks
    RequestTotals totals_;
};

} // namespace stipple::server
