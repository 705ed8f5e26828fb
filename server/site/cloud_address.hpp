// Where a cloud is, and which cloud an address speaks of.
#pragma once

#include "server/http/target.hpp"

#include <optional>
#include <string>

namespace stipple::server {

// "/clouds/ID.stipple"
std::string cloudAddress(const std::string& id);

// The id in "/clouds/ID.stipple", "/api/v1/clouds/ID" and whatever lies below that; whether there is such a
// cloud is another question. Nothing for other addresses.
std::optional<std::string> cloudIdOf(const Target& target);

// "/api/v1/clouds"
bool isCloudList(const Target& target);

} // namespace stipple::server
