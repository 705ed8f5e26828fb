// A picture of any size, by rows: as much of it in memory as one row of parts
// (client/render/picture_parts.hpp).
#pragma once

#include "client/headless/frame_drawer.hpp"

#include <functional>

namespace stipple::headless {

// Some rows of a picture in its whole width; the next call brings those below. An error ends the picture.
using TakeRows = std::function<Status(const Image& rows)>;

// Draws the plan in parts where it is larger than a few thousand pixels, the same picture in any case. Adds
// to plan.counters. Errors: those of the drawer and of `take`.
Status drawRows(FrameDrawer& drawer, FramePlan& plan, const TakeRows& take);

} // namespace stipple::headless
