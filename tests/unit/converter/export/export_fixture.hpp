// Clouds to export, what they hold, and what the exports hold, read back by code that shares nothing with
// what wrote them.
#pragma once

#include "converter/export/export_file.hpp"
#include "shared/format/cloud_file.hpp"
#include "tests/support/small_cloud.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

#include <map>
#include <string>
#include <vector>

namespace stipple::test {

template <class T>
T need(Result<T> result) {
    if (!result.ok())
        FAIL(result.error().sentence());
    return std::move(result).value();
}

// Every point of a cloud in the order of the hierarchy, and the level of its node.
struct AllPoints {
    CloudMetadata metadata;
    PointBatch points;
    std::vector<NodeEntry> nodes; // of each point

    Vec3d world(std::size_t i) const { return metadata.grid.toWorld(points.positions[i]); }
};
AllPoints allPoints(const std::string& path);

// The rows of `all` that `wanted` picks, all attributes.
template <class Wanted>
PointBatch rowsWhere(const AllPoints& all, Wanted wanted) {
    PointBatch rows;
    rows.columns.resize(all.points.columns.size());
    for (std::size_t i = 0; i < all.points.size(); ++i) {
        if (!wanted(i))
            continue;
        rows.positions.push_back(all.points.positions[i]);
        for (std::size_t a = 0; a < rows.columns.size(); ++a) {
            std::size_t size = all.metadata.schema.attributes[a].size();
            const Bytes& column = all.points.columns[a];
            rows.columns[a].insert(rows.columns[a].end(),
                                   column.begin() + static_cast<std::ptrdiff_t>(i * size),
                                   column.begin() + static_cast<std::ptrdiff_t>((i + 1) * size));
        }
    }
    return rows;
}

// A LAS file as a whole.
struct LasContent {
    las::Header header;
    Schema schema;
    PointBatch points;
};
LasContent readLas(const std::string& path);

// CSV by RFC 4180.
struct CsvContent {
    std::vector<std::string> names;
    std::vector<std::vector<std::string>> rows;
};
CsvContent readCsv(const std::string& text);

// Binary little-endian PLY with one element of scalar properties.
struct PlyContent {
    std::vector<std::string> comments;
    std::vector<std::string> names, types;
    std::map<std::string, std::vector<double>> values; // by name
    std::size_t count = 0;
};
PlyContent readPly(const std::string& text);

// "637012.24" with two places is 63701224; a failed test for another number of places.
std::int64_t decimalDigits(const std::string& text, int places);

// Fails the test unless both hold the same points in the same order.
void requireEqual(const PointBatch& a, const PointBatch& b);

// A folder with a cloud made from memory: nodes of 3 levels, points anywhere in them.
struct SmallCloudFile {
    TemporaryFolder folder;
    std::string path = folder / "small.stipple";
    SmallCloud cloud;

    explicit SmallCloudFile(const SmallCloudOptions& options = {});
};

// Bytes on their way to someone: they can't be written again.
class LeavingSink final : public ByteSink {
  public:
    LeavingSink(std::string& body, bool& finished) : body_(body), finished_(finished) {}
    Status finish() override {
        finished_ = true;
        return {};
    }

  private:
    Status put(ByteSpan bytes) override {
        body_.append(bytes.begin(), bytes.end());
        return {};
    }
    std::string& body_;
    bool& finished_;
};

ExportResult exportOrFail(const std::string& input, const std::string& output,
                          const ExportOptions& options = {});
std::string textOf(const std::string& path);

// A flat town of 85 nodes on four levels, on a grid whose world coordinates double holds exactly.
inline SmallCloudOptions quarterGrid() {
    SmallCloudOptions options;
    options.levels = 4;
    options.grid = {{0.25, 0.25, 0.25}, {500000, 4000000, 0}};
    options.rootCube = {{-300, -200, 0}, 12};
    return options;
}

// Exports as LAS and compares with the rows that `wanted` picks; the tallies have to add up.
template <class Wanted>
WalkCounters compareExport(const SmallCloudFile& file, const PointFilter& filter, Wanted wanted) {
    AllPoints all = allPoints(file.path);
    PointBatch expected = rowsWhere(all, wanted);
    ExportOptions options;
    options.filter = filter;
    options.threads = 2;
    ExportResult result = exportOrFail(file.path, file.folder / "out.las", options);
    LasContent las = readLas(file.folder / "out.las");
    CHECK(result.points == expected.size());
    PointBatch found; // the columns the cloud has
    found.positions = las.points.positions;
    for (const Attribute& attribute : all.metadata.schema.attributes) {
        int column = las.schema.find(attribute.name);
        REQUIRE(column >= 0);
        found.columns.push_back(las.points.columns[static_cast<std::size_t>(column)]);
    }
    requireEqual(found, expected);

    const WalkCounters& c = result.counters;
    CHECK(c.pointsTaken == expected.size());
    CHECK(c.whole.points + c.tested.points ==
          c.pointsTaken + c.dropped.bySpacing + c.dropped.byRegion + c.dropped.byAttribute);
    CHECK(c.whole.bytes + c.tested.bytes == c.bytesRead + c.attributeBytesSkipped);
    return c;
}

inline std::uint64_t knownNodes(const WalkCounters& c) {
    return c.whole.nodes + c.tested.nodes + c.outside.nodes + c.finer.nodes + c.absent.nodes;
}

} // namespace stipple::test
