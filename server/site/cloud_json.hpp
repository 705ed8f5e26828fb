// Clouds as the JSON of the API. Numbers are JSON numbers; coordinates are world units.
#pragma once

#include "server/site/cloud_catalog.hpp"

#include <string>
#include <utility>
#include <vector>

namespace stipple::server {

using NamedCloud = std::pair<std::string, std::shared_ptr<const CloudVersion>>; // id, version

// {"clouds": [{"id", "name", "address", "pointCount", "bounds": {"min": [x, y, z], "max": […]} or null,
//              "sizeBytes", "etag", "version"}]}
std::string cloudListJson(const std::vector<NamedCloud>& clouds);

// What the list says of a cloud, and "metadata": the file's own metadata document (docs/FORMAT.md).
std::string cloudJson(const NamedCloud& cloud);

} // namespace stipple::server
