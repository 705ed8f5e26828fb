// What a session shows, to be counted (view_counter.hpp).
#pragma once

#include "client/core/session_loading.hpp"
#include "client/core/session_view.hpp"
#include "client/core/view_counter.hpp"

namespace stipple {

CountedView countedViewOf(const SessionView& view, SessionLoading& loading);

} // namespace stipple
