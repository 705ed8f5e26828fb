#include "tests/unit/shared/format/sample_cloud.hpp"

using namespace stipple;
using namespace stipple::test;

TEST_CASE("the hash of points does not depend on their order or their grouping") {
    CloudMetadata metadata = sampleMetadata();
    PointBatch a = randomPoints(metadata, {}, 300, 1), b = randomPoints(metadata, {}, 77, 2);
    PointHash one, other;
    one.add(metadata.schema, a);
    one.add(metadata.schema, b);
    other.add(hashOf(metadata, b));
    other.add(hashOf(metadata, a));
    CHECK(one == other);
    CHECK(one.hex().size() == 32);
    CHECK(PointHash{0x1F, 2}.hex() == "0000000000000002000000000000001f");
}

TEST_CASE("a lost, doubled or altered point changes the hash") {
    CloudMetadata metadata = sampleMetadata();
    PointBatch points = randomPoints(metadata, {}, 200, 1);
    PointHash hash = hashOf(metadata, points);
    for (std::size_t c = 0; c < points.columns.size(); ++c)
        for (std::size_t byte : {std::size_t{0}, points.columns[c].size() - 1}) {
            PointBatch altered = points;
            altered.columns[c][byte] ^= 1;
            CHECK(!(hashOf(metadata, altered) == hash));
        }
    for (int axis = 0; axis < 3; ++axis) {
        PointBatch altered = points;
        altered.positions[150][axis] += 1;
        CHECK(!(hashOf(metadata, altered) == hash));
    }
    PointBatch swapped = points; // one value for another between two points
    std::swap(swapped.positions[3].x, swapped.positions[4].x);
    CHECK(!(hashOf(metadata, swapped) == hash));
    PointHash twice = hash;
    twice.add(hash);
    CHECK(!(twice == hash));
}
