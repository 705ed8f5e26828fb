// What the JSON of answers looks like: JSON schemas (2020-12), by name, as text. Every member is described,
// and no other may come.
#pragma once

#include <string_view>

namespace stipple::server {

extern const std::string_view cloudSchemas; // clouds and their parts; {"CloudList": {…}, …}
extern const std::string_view pointSchemas; // nodes and points

} // namespace stipple::server
