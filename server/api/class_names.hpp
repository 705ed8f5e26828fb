// What the values of the attribute Classification are called.
#pragma once

#include "shared/points/attribute.hpp"

#include <string_view>

namespace stipple::server {

// LAS 1.4 R15, table 17 (point formats 6-10) or table 9 (0-5), whichever the attributes come from.
std::string_view className(const Schema& schema, int value);

} // namespace stipple::server
