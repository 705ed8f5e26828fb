// Whether the inner nodes of a cloud keep their minimum distance, by looking at all pairs.
#pragma once

#include "shared/format/cloud_file.hpp"
#include "shared/io/file_source.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace stipple::test {

struct NodePoint {
    Vec3d world;
    std::size_t node = 0;
};

// Pairs nearer than `distance`, found by a sweep along x; counts points that have one in their own node and
// in another.
struct NearCounts {
    std::size_t points = 0, nearInside = 0, nearAcross = 0;
};
inline NearCounts countNear(std::vector<NodePoint> points, double distance) {
    std::sort(points.begin(), points.end(),
              [](const NodePoint& a, const NodePoint& b) { return a.world.x < b.world.x; });
    std::vector<std::uint8_t> inside(points.size()), across(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = i + 1; j < points.size() && points[j].world.x - points[i].world.x < distance;
             ++j) {
            if (length(points[j].world - points[i].world) >= distance * (1 - 1e-9))
                continue;
            auto& which = points[i].node == points[j].node ? inside : across;
            which[i] = which[j] = 1;
        }
    NearCounts counts;
    counts.points = points.size();
    counts.nearInside = static_cast<std::size_t>(std::count(inside.begin(), inside.end(), 1));
    counts.nearAcross = static_cast<std::size_t>(std::count(across.begin(), across.end(), 1));
    return counts;
}

// The points of inner nodes, by level.
inline std::map<int, std::vector<NodePoint>> innerPoints(CloudReader& reader) {
    std::map<int, std::vector<NodePoint>> levels;
    std::size_t node = 0;
    REQUIRE(reader
                .visitNodes([&](const NodeEntry& entry) -> Status {
                    ++node;
                    if (entry.childMask == 0)
                        return {};
                    STIPPLE_TRY(batch, reader.readNode(entry));
                    for (Vec3i p : batch.positions)
                        levels[entry.key.level].push_back({reader.metadata().grid.toWorld(p), node});
                    return {};
                })
                .ok());
    return levels;
}

inline void checkMinimumDistance(const std::string& cloud) {
    auto source = openFileSource(cloud);
    REQUIRE(source.ok());
    auto reader = CloudReader::open(**source);
    REQUIRE(reader.ok());
    auto levels = innerPoints(**reader);
    CHECK(levels.size() >= 2);
    for (const auto& [level, points] : levels) {
        INFO("level " << level);
        NearCounts counts = countNear(points, std::ldexp((*reader)->metadata().spacing, -level));
        CHECK(counts.nearInside == 0);
        CHECK(counts.nearAcross == 0);
        CHECK(counts.points > 1000);
    }
}

} // namespace stipple::test
