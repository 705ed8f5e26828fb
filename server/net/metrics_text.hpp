// Measurements in Prometheus' text format. Internal to server/net.
#pragma once

#include "server/http/measurement.hpp"
#include "server/net/request_metrics.hpp"

#include <string>
#include <vector>

namespace stipple::server {

inline constexpr const char* metricsMediaType = "text/plain; version=0.0.4; charset=utf-8";

std::string metricsText(const RequestTotals& totals, const std::vector<Measurement>& measurements);

// Of this process: descriptors, memory, processor time; named as Prometheus' own clients name them.
std::vector<Measurement> processMeasurements();

} // namespace stipple::server
