// Points in memory, as columns: positions in grid integers, then each attribute's raw little-endian bytes.
// The unit in which readers hand out points and writers take them.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/geometry/vec3.hpp"
#include "shared/points/attribute.hpp"

#include <vector>

namespace stipple {

struct PointBatch {
    std::vector<Vec3i> positions; // grid integers of the cloud or file the batch belongs to
    std::vector<Bytes> columns;   // columns[a].size() == positions.size() × schema.attributes[a].size()

    std::size_t size() const { return positions.size(); }

    // Sizes every column for `count` points of `schema`; contents of new points are zero.
    void resize(const Schema& schema, std::size_t count) {
        positions.resize(count);
        columns.resize(schema.attributes.size());
        for (std::size_t a = 0; a < columns.size(); ++a)
            columns[a].resize(count * schema.attributes[a].size());
    }

    // Value `index` of attribute column `a`, which must be stored as T with one component.
    template <class T>
    T value(int a, std::size_t index) const {
        return loadLe<T>(columns[static_cast<std::size_t>(a)].data() + index * sizeof(T));
    }
    template <class T>
    void setValue(int a, std::size_t index, T value) {
        storeLe<T>(columns[static_cast<std::size_t>(a)].data() + index * sizeof(T), value);
    }
};

} // namespace stipple
