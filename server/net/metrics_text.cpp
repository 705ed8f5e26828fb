#include "server/net/metrics_text.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <prometheus/text_serializer.h>
#include <sstream>
#include <sys/resource.h>
#include <unistd.h>

namespace stipple::server {

namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;
using Labels = std::vector<std::pair<std::string, std::string>>;

ClientMetric labelled(const Labels& labels) {
    ClientMetric metric;
    for (const auto& [name, value] : labels)
        metric.label.push_back({name, value});
    return metric;
}

// Families of the same name become one, as the format demands.
class Families {
  public:
    ClientMetric& add(const std::string& name, const std::string& help, MetricType type,
                      const Labels& labels) {
        auto found = std::find_if(all_.begin(), all_.end(),
                                  [&](const MetricFamily& family) { return family.name == name; });
        if (found == all_.end())
            found = all_.insert(all_.end(), MetricFamily{name, help, type, {}});
        found->metric.push_back(labelled(labels));
        return found->metric.back();
    }
    void count(const std::string& name, const std::string& help, double value, const Labels& labels = {}) {
        add(name, help, MetricType::Counter, labels).counter.value = value;
    }
    std::string text() const {
        std::ostringstream out;
        prometheus::TextSerializer().Serialize(out, all_);
        return out.str();
    }

  private:
    std::vector<MetricFamily> all_;
};

void addDurations(Families& families, const RequestTotals::OfRoute& totals, const Labels& labels) {
    auto& histogram =
        families
            .add("stipple_http_request_duration_seconds",
                 "From the end of a request's header to the last byte of its answer handed to the system",
                 MetricType::Histogram, labels)
            .histogram;
    histogram.sample_count = totals.count;
    histogram.sample_sum = totals.seconds;
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < RequestTotals::secondsBounds.size(); ++i) {
        below += totals.bySeconds[i];
        histogram.bucket.push_back({below, RequestTotals::secondsBounds[i]});
    }
}

void addRoute(Families& families, Route route, const RequestTotals::OfRoute& totals) {
    Labels labels{{"route", routeName(route)}};
    for (std::size_t statusClass = 1; statusClass < totals.byStatusClass.size(); ++statusClass) {
        Labels withStatus = labels;
        withStatus.emplace_back("status", std::to_string(statusClass) + "xx");
        if (totals.byStatusClass[statusClass] > 0)
            families.count("stipple_http_requests_total", "Requests that were answered",
                           static_cast<double>(totals.byStatusClass[statusClass]), withStatus);
    }
    families.count("stipple_http_response_body_bytes_total", "Bytes of bodies handed to the system",
                   static_cast<double>(totals.bodyBytes), labels);
    addDurations(families, totals, labels);
}

} // namespace

std::string metricsText(const RequestTotals& totals, const std::vector<Measurement>& measurements) {
    Families families;
    for (std::size_t i = 0; i < routeCount; ++i)
        addRoute(families, static_cast<Route>(i), totals.routes[i]);
    families.count("stipple_http_answers_cut_total", "Answers that ended before their end",
                   static_cast<double>(totals.cut));
    families.add("stipple_http_requests_in_flight", "Requests that are being answered", MetricType::Gauge, {})
        .gauge.value = totals.inFlight;
    for (const auto& [id, cloud] : totals.clouds) {
        families.count("stipple_cloud_requests_total", "Requests for a cloud, its file or parts of it",
                       static_cast<double>(cloud.requests), {{"cloud", id}});
        families.count("stipple_cloud_response_body_bytes_total", "Bytes of bodies of answers about a cloud",
                       static_cast<double>(cloud.bodyBytes), {{"cloud", id}});
    }
    for (const Measurement& measurement : measurements) {
        MetricType type = measurement.isCounter ? MetricType::Counter : MetricType::Gauge;
        ClientMetric& metric = families.add(measurement.name, measurement.help, type, measurement.labels);
        (measurement.isCounter ? metric.counter.value : metric.gauge.value) = measurement.value;
    }
    return families.text();
}

std::vector<Measurement> processMeasurements() {
    std::error_code problem;
    double openDescriptors = 0;
    for (std::filesystem::directory_iterator at("/proc/self/fd", problem), end; !problem && at != end;
         at.increment(problem))
        ++openDescriptors;
    struct rlimit descriptors {};
    ::getrlimit(RLIMIT_NOFILE, &descriptors);
    struct rusage usage {};
    ::getrusage(RUSAGE_SELF, &usage);
    auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) / 1e6;
    };
    double pages = 0, residentPages = 0;
    std::ifstream("/proc/self/statm") >> pages >> residentPages;
    double pageBytes = static_cast<double>(::sysconf(_SC_PAGESIZE));
    return {
        {"process_open_fds", "Open files, sockets and the like", false, openDescriptors},
        {"process_max_fds", "Most that the system allows", false, static_cast<double>(descriptors.rlim_cur)},
        {"process_resident_memory_bytes", "Memory in use", false, residentPages * pageBytes},
        {"process_virtual_memory_bytes", "Address space in use", false, pages * pageBytes},
        {"process_cpu_seconds_total", "Processor time, user and system", true,
         seconds(usage.ru_utime) + seconds(usage.ru_stime)}};
}

} // namespace stipple::server
