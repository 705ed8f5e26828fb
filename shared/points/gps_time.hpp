// What a cloud's GPS Time counts from is the attribute's description.
#pragma once

namespace stipple {

inline constexpr const char* standardGpsTimeText = "adjusted standard GPS time";
inline constexpr const char* weekGpsTimeText = "GPS week time";

} // namespace stipple
