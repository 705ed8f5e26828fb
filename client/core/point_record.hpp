// One point of a cloud, exactly as its file has it.
#pragma once

#include "shared/base/result.hpp"
#include "shared/geometry/node_key.hpp"
#include "shared/geometry/vec3.hpp"
#include "shared/points/attribute.hpp"

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace stipple {

// Where a point is in its cloud; the same for as long as the file is.
struct PointIdentity {
    std::uint32_t cloud = 0; // CloudId
    NodeKey node;
    std::uint32_t index = 0; // in the node's progressive order
    friend bool operator==(const PointIdentity&, const PointIdentity&) = default;
};

using StoredNumber = std::variant<std::int64_t, std::uint64_t, double>;

struct PointValue {
    Attribute attribute;              // value = offset + scale × stored
    std::vector<StoredNumber> stored; // one a component
    // Of component `i`.
    double value(std::size_t i = 0) const {
        double number = std::visit([](auto exact) { return static_cast<double>(exact); }, stored[i]);
        return attribute.offset + attribute.scale * number;
    }
};

struct PointRecord {
    Vec3i integers;                 // of the cloud's grid, as in the scan
    Vec3d position;                 // world: offset + scale × integer
    std::vector<PointValue> values; // in the order of the cloud's schema; empty until they were read
};

struct PointAnswer {
    PointIdentity point;
    Result<PointRecord> record;
};

} // namespace stipple
