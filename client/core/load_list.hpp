// What a session asks for, most urgent first: what opens clouds, answers to questions about points, the
// hierarchy, then nodes by what they add to the picture for their bytes (load_value.hpp), exact colours,
// watched attributes, and behind all of it the regions that are read.
#pragma once

#include "client/core/session_loading.hpp"
#include "client/core/session_view.hpp"

#include <vector>

namespace stipple {

// `isWatching`: CloudLoader::watched is wanted of what is selected.
std::vector<LoadItem> loadList(const SessionView& view, SessionLoading& loading, const SessionLimits& limits,
                               bool isWatching);

} // namespace stipple
