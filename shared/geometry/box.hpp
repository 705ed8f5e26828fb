// Axis-aligned boxes. `max` is inclusive: a box of one point has min == max. A default box is empty.
#pragma once

#include "shared/geometry/vec3.hpp"

#include <algorithm>
#include <limits>

namespace stipple {

template <class T>
struct Box {
    Vec3<T> min{std::numeric_limits<T>::max(), std::numeric_limits<T>::max(), std::numeric_limits<T>::max()};
    Vec3<T> max{std::numeric_limits<T>::lowest(), std::numeric_limits<T>::lowest(),
                std::numeric_limits<T>::lowest()};

    bool empty() const { return min.x > max.x || min.y > max.y || min.z > max.z; }
    void extend(Vec3<T> p) {
        for (int axis = 0; axis < 3; ++axis) {
            min[axis] = std::min(min[axis], p[axis]);
            max[axis] = std::max(max[axis], p[axis]);
        }
    }
    void extend(const Box& other) {
        if (!other.empty()) {
            extend(other.min);
            extend(other.max);
        }
    }
    bool contains(Vec3<T> p) const {
        return p.x >= min.x && p.x <= max.x && p.y >= min.y && p.y <= max.y && p.z >= min.z && p.z <= max.z;
    }
    friend bool operator==(const Box&, const Box&) = default;
};

using BoxD = Box<double>;
using BoxI = Box<std::int64_t>;

} // namespace stipple
