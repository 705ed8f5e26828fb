// The frame plan of what a session has selected, as far as it is here.
#pragma once

#include "client/core/plan_painter.hpp"
#include "client/core/session_loading.hpp"
#include "client/core/session_view.hpp"

namespace stipple {

// Paints what is drawn where that changed. `last`: the plan that was drawn before, of which nodes go on being
// shown where more is new than a frame may bring (upload_gate.hpp); counters().nodesDelayed > 0 then, and the
// next frame brings more.
FramePlan makePlan(const SessionView& view, const SessionLimits& limits, SessionLoading& loading,
                   PlanPainter& painter, const FramePlan& last);

// Whether the two show the same.
bool samePicture(const FramePlan& a, const FramePlan& b);

} // namespace stipple
