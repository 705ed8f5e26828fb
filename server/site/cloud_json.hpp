// Clouds as the JSON of the API. Numbers are JSON numbers; coordinates are world units.
#pragma once

#include "server/site/cloud_catalog.hpp"

#include <string>
#include <utility>
#include <vector>

namespace stipple::server {

struct CloudList {
    std::vector<std::pair<std::string, CloudSummary>> clouds; // id, what is said of it
    std::string next;                                         // address of what follows; empty: nothing does
};

// {"clouds": [{"id", "name", "address", "pointCount", "bounds": {"min": [x, y, z], "max": […]} or null,
//              "sizeBytes", "etag", "version"}], "next": address or absent}
std::string cloudListJson(const CloudList& list);

// What the list says of a cloud, and "metadata": the file's own metadata document (docs/FORMAT.md).
std::string cloudJson(const std::string& id, const CloudVersion& version);

} // namespace stipple::server
