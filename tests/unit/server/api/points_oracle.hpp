// What answers of points are compared with: every point of a cloud, and what files hold, read back.
#pragma once

#include "shared/format/cloud_file.hpp"
#include "shared/las/las_reader.hpp"
#include "tests/unit/server/api/api_fixture.hpp"

#include <functional>
#include <string>
#include <vector>

namespace stipple::test {

// A flat town of 85 nodes on four levels, on a grid whose world coordinates double holds exactly.
SmallCloudOptions quarterTown();

// Every point in the order of the hierarchy, and which of its node's it is.
struct EveryPoint {
    CloudMetadata metadata;
    PointBatch points;
    std::vector<NodeKey> nodes;
    std::vector<std::uint32_t> indices;

    explicit EveryPoint(const Bytes& file);
    Vec3d world(std::size_t i) const { return metadata.grid.toWorld(points.positions[i]); }
    double value(const std::string& attribute, std::size_t i) const; // uint16
    PointBatch where(const std::function<bool(std::size_t)>& wanted) const;
};

struct LasAnswer {
    las::Header header;
    Schema schema;
    PointBatch points;
    // The columns that a schema names, in its order.
    PointBatch columnsOf(const Schema& names) const;
};
LasAnswer lasOf(const std::string& body); // LAS or LAZ

std::vector<std::vector<std::string>>
csvRows(const std::string& body); // the names first; nothing is quoted in it
std::string plyHeader(const std::string& body);

bool operator==(const PointBatch& a, const PointBatch& b);

// Percent-encodes what is not unreserved.
std::string encoded(const std::string& text);

} // namespace stipple::test
