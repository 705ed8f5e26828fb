#include "converter/build/morton.hpp"

namespace stipple {

int compareMorton(Vec3i a, Vec3i b) {
    int decides = 2;
    std::uint64_t highest = static_cast<std::uint64_t>(a.z ^ b.z);
    for (int axis = 1; axis >= 0; --axis) {
        std::uint64_t difference = static_cast<std::uint64_t>(a[axis] ^ b[axis]);
        // The highest bit of `difference` is above that of `highest` (M. Connor, P. Kumar 2010, §3.1).
        if (highest < difference && highest < (highest ^ difference)) {
            decides = axis;
            highest = difference;
        }
    }
    return a[decides] < b[decides] ? -1 : a[decides] > b[decides] ? 1 : 0;
}

} // namespace stipple
