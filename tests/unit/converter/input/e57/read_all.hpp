// An E57 file's points, all parts together, for tests.
#pragma once

#include "converter/input/e57/e57_input.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/converter/input/e57/e57_bytes.hpp"

namespace stipple::test {

struct E57Points {
    InputDescription description;
    std::vector<InputPart> parts;
    PointBatch points;
    ReadReport report;

    std::vector<Vec3d> world() const {
        std::vector<Vec3d> result;
        for (Vec3i p : points.positions)
            result.push_back(description.grid.toWorld(p));
        return result;
    }
    // The values of an attribute of T.
    template <class T>
    std::vector<T> values(std::string_view name) const {
        int a = description.schema.find(name);
        REQUIRE(a >= 0);
        const Attribute& attribute = description.schema.attributes[static_cast<std::size_t>(a)];
        REQUIRE(attribute.size() == sizeof(T));
        std::vector<T> result;
        for (std::size_t i = 0; i < points.size(); ++i)
            result.push_back(points.value<T>(a, i));
        return result;
    }
    const Attribute& attribute(std::string_view name) const {
        int a = description.schema.find(name);
        REQUIRE(a >= 0);
        return description.schema.attributes[static_cast<std::size_t>(a)];
    }
};

inline std::string writeBytes(const std::string& path, const Bytes& bytes) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return path;
}

// Checks the interface's promises on the way: sizes of batches, counts of parts, bounds.
inline Result<E57Points> readE57(const std::string& path, double scale = 0, int threads = 1) {
    E57Points result;
    STIPPLE_TRY(input, openE57Input(path, {.scale = scale, .threads = threads}));
    result.description = input->description();
    result.parts = input->parts();
    const Schema& schema = result.description.schema;
    result.points.resize(schema, 0);
    std::uint64_t total = 0;
    for (std::size_t p = 0; p < result.parts.size(); ++p) {
        STIPPLE_TRY(stream, input->openPart(p));
        std::uint64_t inPart = 0;
        PointBatch batch;
        for (;;) {
            STIPPLE_CHECK(stream->next(batch));
            if (batch.size() == 0)
                break;
            REQUIRE(batch.size() <= pointsPerBatch);
            inPart += batch.size();
            result.points.positions.insert(result.points.positions.end(), batch.positions.begin(),
                                           batch.positions.end());
            for (std::size_t a = 0; a < schema.attributes.size(); ++a) {
                REQUIRE(batch.columns[a].size() == batch.size() * schema.attributes[a].size());
                Bytes& column = result.points.columns[a];
                column.insert(column.end(), batch.columns[a].begin(), batch.columns[a].end());
            }
        }
        REQUIRE(inPart == result.parts[p].points);
        total += inPart;
        result.report.add(stream->report());
    }
    REQUIRE(total == result.description.source.pointCount);
    BoxI box;
    for (Vec3i p : result.points.positions)
        box.extend(p);
    if (result.description.boundsAreMeasured)
        REQUIRE(result.description.bounds == box);
    return result;
}

inline E57Points readE57(const E57File& file, double scale = 0) {
    TemporaryFolder folder;
    auto points = readE57(writeBytes(folder.file("scan.e57"), file.bytes()), scale);
    INFO((points ? "" : points.error().sentence()));
    REQUIRE(points.ok());
    return std::move(points).value();
}

inline Error e57Error(const Bytes& bytes) {
    TemporaryFolder folder;
    auto points = readE57(writeBytes(folder.file("scan.e57"), bytes));
    REQUIRE(!points.ok());
    CHECK(points.error().where.find("scan.e57") != std::string::npos);
    return points.error();
}
inline Error e57Error(const E57File& file) {
    return e57Error(file.bytes());
}

} // namespace stipple::test
