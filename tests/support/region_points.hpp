// The points of a region in two ways: by a session's scan, and by testing every point of the file.
#pragma once

#include "client/core/view_session.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/memory_source.hpp"
#include "shared/select/point_chooser.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <functional>
#include <numeric>
#include <vector>

namespace stipple::test {

// A point's integers, then the bytes of its attributes.
using PointRow = std::pair<std::array<std::int64_t, 3>, Bytes>;

inline void addRows(const PointBatch& batch, std::vector<PointRow>& rows) {
    for (std::size_t i = 0; i < batch.size(); ++i) {
        Bytes values;
        for (const Bytes& column : batch.columns) {
            std::size_t width = column.size() / batch.size();
            values.insert(values.end(), column.begin() + static_cast<std::ptrdiff_t>(i * width),
                          column.begin() + static_cast<std::ptrdiff_t>((i + 1) * width));
        }
        Vec3i p = batch.positions[i];
        rows.push_back({{p.x, p.y, p.z}, std::move(values)});
    }
}

inline std::vector<int> allAttributes(const CloudMetadata& metadata) {
    std::vector<int> attributes(metadata.schema.attributes.size());
    std::iota(attributes.begin(), attributes.end(), 0);
    return attributes;
}

// Sorted.
inline std::vector<PointRow> rowsByTesting(ByteSource& source, const std::function<bool(Vec3d)>& holds) {
    auto reader = CloudReader::open(source);
    REQUIRE(reader.ok());
    const CloudMetadata& metadata = (*reader)->metadata();
    std::vector<PointRow> rows;
    Status visited = (*reader)->visitNodes([&](const NodeEntry& entry) -> Status {
        STIPPLE_TRY(batch, (*reader)->readNode(entry));
        std::vector<PointRow> all;
        addRows(batch, all);
        for (std::size_t i = 0; i < all.size(); ++i)
            if (holds(metadata.grid.toWorld(batch.positions[i])))
                rows.push_back(std::move(all[i]));
        return {};
    });
    REQUIRE(visited.ok());
    std::sort(rows.begin(), rows.end());
    return rows;
}

struct ScannedRows {
    std::vector<PointRow> rows; // sorted
    std::vector<int> levels;    // of the nodes, in the order in which they came
    RegionProgress progress;
};

// Updates the session until the scan is complete; a failed test if it ends otherwise. `perTurn`: nodes taken
// between two updates. `turn` is called after each.
inline ScannedRows rowsByScan(
    ViewSession& session, const RegionRequest& request, std::size_t perTurn = 4,
    const std::function<void()>& turn = [] {}) {
    std::shared_ptr<const CloudMetadata> metadata;
    for (const CloudState& cloud : session.clouds())
        if (cloud.id == request.cloud)
            metadata = cloud.metadata;
    REQUIRE(metadata);
    auto filter = CloudFilter::make(*metadata, request.filter);
    REQUIRE(filter.ok());
    auto chooser = PointChooser::make(*metadata, *filter, request.attributes);
    REQUIRE(chooser.ok());
    auto scan = session.scanRegion(request);
    REQUIRE(scan.ok());
    ScannedRows scanned;
    for (int i = 0; i < 100'000; ++i) {
        session.update(std::chrono::milliseconds(20));
        for (const RegionNode& node : session.takeRegionNodes(*scan, perTurn)) {
            CloudFilter::Dropped dropped;
            auto batch = chooser->choose(node.node, node.tested, dropped);
            if (!batch.ok())
                FAIL(batch.error().sentence());
            addRows(*batch, scanned.rows);
            scanned.levels.push_back(node.node.entry.key.level);
        }
        turn();
        scanned.progress = session.regionProgress(*scan);
        if (scanned.progress.error)
            FAIL(scanned.progress.error->sentence());
        if (scanned.progress.complete)
            break;
    }
    REQUIRE(scanned.progress.complete);
    session.endRegionScan(*scan);
    std::sort(scanned.rows.begin(), scanned.rows.end());
    return scanned;
}

} // namespace stipple::test
