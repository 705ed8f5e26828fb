// Media types by file name.
#pragma once

#include <string_view>

namespace stipple::server {

// "application/octet-stream" where the extension says nothing.
std::string_view contentTypeOf(std::string_view fileName);

} // namespace stipple::server
