// A number that /metrics shows, by Prometheus' rules: names in snake_case with their unit at the end,
// counters end in _total and never fall.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace stipple::server {

struct Measurement {
    std::string name, help; // measurements of one name have the same help and differ in their labels
    bool isCounter = false; // else a gauge
    double value = 0;
    std::vector<std::pair<std::string, std::string>> labels = {};
};

} // namespace stipple::server
