#include "server/net/request_metrics.hpp"

#include <algorithm>
#include <cctype>

namespace stipple::server {

namespace {

constexpr std::string_view cloudFiles = "/clouds/", apiClouds = "/api/v1/clouds/", fileSuffix = ".stipple";

bool isIdByte(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' || c == '-';
}

// Statuses that are only given for clouds that there are.
bool provesThatItExists(int status) {
    return (status >= 200 && status < 400) || status == 412 || status == 416;
}

} // namespace

const char* routeName(Route route) {
    static constexpr std::array<const char*, routeCount> names{"page", "cloud-file", "api", "operations",
                                                               "invalid"};
    return names[static_cast<std::size_t>(route)];
}

Route routeOf(std::string_view target) {
    if (target.empty())
        return Route::invalid;
    if (target.starts_with(cloudFiles))
        return Route::cloudFile;
    if (target.starts_with("/api/"))
        return Route::api;
    std::string_view path = target.substr(0, target.find('?'));
    return path == "/healthz" || path == "/readyz" || path == "/metrics" ? Route::operations : Route::page;
}

std::optional<std::string_view> cloudOf(std::string_view target) {
    std::string_view path = target.substr(0, target.find('?')), id;
    if (path.starts_with(cloudFiles) && path.ends_with(fileSuffix))
        id = path.substr(cloudFiles.size(), path.size() - cloudFiles.size() - fileSuffix.size());
    else if (path.starts_with(apiClouds))
        id = path.substr(apiClouds.size(), path.find('/', apiClouds.size()) - apiClouds.size());
    if (id.empty() || !std::all_of(id.begin(), id.end(), isIdByte))
        return std::nullopt;
    return id;
}

RequestTotals::OfCloud& RequestTotals::ofCloud(std::string_view id) {
    auto found = clouds.find(id);
    if (found != clouds.end())
        return found->second;
    return clouds[clouds.size() < maxClouds ? std::string(id) : otherClouds];
}

void RequestTotals::add(const RequestTotals& other) {
    for (std::size_t i = 0; i < routeCount; ++i) {
        OfRoute& route = routes[i];
        const OfRoute& more = other.routes[i];
        for (std::size_t c = 0; c < route.byStatusClass.size(); ++c)
            route.byStatusClass[c] += more.byStatusClass[c];
        for (std::size_t b = 0; b < route.bySeconds.size(); ++b)
            route.bySeconds[b] += more.bySeconds[b];
        route.bodyBytes += more.bodyBytes;
        route.count += more.count;
        route.seconds += more.seconds;
    }
    for (const auto& [id, more] : other.clouds) {
        OfCloud& cloud = ofCloud(id);
        cloud.requests += more.requests;
        cloud.bodyBytes += more.bodyBytes;
    }
    cut += other.cut;
    inFlight += other.inFlight;
}

void RequestMetrics::ended(const Sample& sample) {
    inFlight_.fetch_sub(1, std::memory_order_relaxed);
    const auto& bounds = RequestTotals::secondsBounds;
    auto bucket = std::lower_bound(bounds.begin(), bounds.end(), sample.seconds) - bounds.begin();
    std::lock_guard lock(mutex_);
    auto& route = totals_.routes[static_cast<std::size_t>(routeOf(sample.target))];
    ++route.byStatusClass[static_cast<std::size_t>(std::clamp(sample.status / 100, 0, 5))];
    route.bodyBytes += sample.bodyBytes;
    ++route.count;
    ++route.bySeconds[static_cast<std::size_t>(bucket)];
    route.seconds += sample.seconds;
    totals_.cut += sample.isComplete ? 0 : 1;
    if (auto cloud = cloudOf(sample.target); cloud && provesThatItExists(sample.status)) {
        auto& ofCloud = totals_.ofCloud(*cloud);
        ++ofCloud.requests;
        ofCloud.bodyBytes += sample.bodyBytes;
    }
}

RequestTotals RequestMetrics::totals() const {
    std::lock_guard lock(mutex_);
    RequestTotals totals = totals_;
    totals.inFlight = inFlight_.load(std::memory_order_relaxed);
    return totals;
}

} // namespace stipple::server
