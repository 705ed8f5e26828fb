// Where a picture shows nothing coarse: nodes that are drawn whole, and whose children are too, as far as
// they are in view. Of clouds whose inner nodes show means of colours, the exact ones are wanted there.
#pragma once

#include "client/core/session_view.hpp"

namespace stipple {

// Of the view's selection: (cloud index, node).
std::set<std::pair<std::uint32_t, std::uint32_t>> exactNodes(const SessionView& view, const CloudMap& clouds);

} // namespace stipple
