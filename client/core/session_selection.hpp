// The selection of a session: which of its clouds take part, and with what limits.
#pragma once

#include "client/core/session_view.hpp"

namespace stipple {

// Sets view.selection, view.clouds and view.exact from view.transform. `coarser`: factor of the spacing
// between points that the frame time asks for, >= 1.
void selectNodes(SessionView& view, CloudMap& clouds, const SessionLimits& limits, double coarser);

// World box of the visible, ready clouds; empty if there are none.
BoxD shownBounds(const CloudMap& clouds);

} // namespace stipple
