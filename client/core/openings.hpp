// Which clouds of a scene are opened at all.
#pragma once

#include "client/core/session_view.hpp"

#include <cstdint>

namespace stipple {

// Decides for each cloud that is not open yet whether the view needs it (ViewSession::addCloud): sets
// CloudLoader::isToOpen. How many it does not.
std::uint64_t chooseOpenings(CloudMap& clouds, const SessionView& view);

// Radius in pixels of what a cloud is said to fill; infinite where nobody said.
double openingPixels(const CloudLoader& cloud, const SessionView& view);

} // namespace stipple
