#include "converter/build/verify.hpp"

#include "shared/format/cloud_file.hpp"
#include "shared/format/point_hash.hpp"
#include "shared/io/file_source.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {
// Writes the cloud again, its nodes changed by `change`, with the hash and counts that go with the change, so
// that nothing but a comparison with the inputs can tell.
void rewrite(const std::string& from, const std::string& to,
             const std::function<void(const CloudMetadata&, const NodeEntry&, PointBatch&)>& change,
             bool keepsHash = false) {
    auto source = openFileSource(from);
    REQUIRE(source.ok());
    auto reader = CloudReader::open(**source);
    REQUIRE(reader.ok());
    CloudMetadata metadata = (*reader)->metadata();
    auto writer = CloudWriter::create(to);
    REQUIRE(writer.ok());
    PointHash hash;
    metadata.pointCount = 0;
    Status visited = (*reader)->visitNodes([&](const NodeEntry& entry) -> Status {
        STIPPLE_TRY(batch, (*reader)->readNode(entry));
        change(metadata, entry, batch);
        hash.add(metadata.schema, batch);
        metadata.pointCount += batch.size();
        STIPPLE_TRY(encoded, encodeNode(metadata, entry.key, batch));
        return (*writer)->add(encoded);
    });
    REQUIRE(visited.ok());
    if (!keepsHash)
        metadata.pointHash = hash.hex();
    REQUIRE((*writer)->finish(metadata).ok());
}

void removeLast(const Schema& schema, PointBatch& batch) {
    batch.resize(schema, batch.size() - 1);
}
void doubleLast(const Schema& schema, PointBatch& batch) {
    std::size_t last = batch.size() - 1;
    batch.resize(schema, batch.size() + 1);
    batch.positions[last + 1] = batch.positions[last];
    for (std::size_t a = 0; a < schema.attributes.size(); ++a) {
        std::size_t size = schema.attributes[a].size();
        std::memcpy(batch.columns[a].data() + (last + 1) * size, batch.columns[a].data() + last * size, size);
    }
}

struct Fixture {
    TemporaryFolder folder;
    std::string scan = folder / "in.las", cloud = folder / "c.stipple", altered = folder / "altered.stipple";

    Fixture() {
        writeScan(surfaceScan(3, 3000, 1), scan);
        convertOrFail({scan}, cloud);
    }
    VerifyReport verify(const std::vector<std::string>& inputs) {
        auto report = verifyFile(altered, inputs, 1, nullptr, noProgress);
        if (!report)
            FAIL(report.error().sentence());
        return std::move(report).value();
    }
};
} // namespace

TEST_CASE_METHOD(Fixture, "a point altered in one attribute is found, with its attribute", "[verify]") {
    rewrite(cloud, altered, [](const CloudMetadata& metadata, const NodeEntry&, PointBatch& batch) {
        int time = metadata.schema.find("GPS Time");
        batch.setValue<double>(time, 17, batch.value<double>(time, 17) + 1e-6);
    });
    VerifyReport report = verify({scan});
    CHECK_FALSE(report.passed());
    REQUIRE(report.comparison);
    CHECK(report.comparison->changed == 1);
    CHECK(report.comparison->equalPoints == 2999);
    for (std::size_t a = 0; a < report.attributeNames.size(); ++a)
        CHECK(report.comparison->changedPerAttribute[a] ==
              (report.attributeNames[a] == "GPS Time" ? 1u : 0u));
    REQUIRE(report.comparison->first.size() == 1);
    CHECK(report.comparison->first[0].find("GPS Time is ") != std::string::npos);
}

TEST_CASE_METHOD(Fixture, "a dropped point is found", "[verify]") {
    rewrite(cloud, altered, [](const CloudMetadata& metadata, const NodeEntry&, PointBatch& batch) {
        removeLast(metadata.schema, batch);
    });
    VerifyReport report = verify({scan});
    CHECK_FALSE(report.passed());
    CHECK(report.comparison->missing == 1);
    CHECK(report.comparison->surplus == 0);
}

TEST_CASE_METHOD(Fixture, "a doubled point is found", "[verify]") {
    rewrite(cloud, altered, [](const CloudMetadata& metadata, const NodeEntry&, PointBatch& batch) {
        doubleLast(metadata.schema, batch);
    });
    VerifyReport report = verify({scan});
    CHECK_FALSE(report.passed());
    CHECK(report.comparison->surplus == 1);
    CHECK(report.comparison->missing == 0);
}

TEST_CASE_METHOD(Fixture, "a point moved by one step is found", "[verify]") {
    rewrite(cloud, altered, [](const CloudMetadata& metadata, const NodeEntry&, PointBatch& batch) {
        batch.positions[5].x += batch.positions[5].x > metadata.rootCube.min.x ? -1 : 1;
    });
    VerifyReport report = verify({scan});
    CHECK_FALSE(report.passed());
    CHECK(report.comparison->missing + report.comparison->changed == 1);
}

TEST_CASE_METHOD(Fixture, "without inputs the hash tells", "[verify]") {
    rewrite(
        cloud, altered,
        [](const CloudMetadata& metadata, const NodeEntry&, PointBatch& batch) {
            int source = metadata.schema.find("Point Source ID");
            batch.setValue<std::uint16_t>(
                source, 3, static_cast<std::uint16_t>(batch.value<std::uint16_t>(source, 3) ^ 1));
        },
        true);
    VerifyReport report = verify({});
    CHECK_FALSE(report.passed());
    REQUIRE(report.faultCount >= 1);
    CHECK(report.faults[0].find("hash") != std::string::npos);
}

TEST_CASE_METHOD(Fixture, "the cloud of other points is told from the inputs'", "[verify]") {
    writeScan(surfaceScan(3, 3000, 2), folder / "other.las");
    convertOrFail({folder / "other.las"}, altered);
    CHECK(verify({}).passed());
    VerifyReport report = verify({scan});
    CHECK_FALSE(report.passed());
    CHECK(report.comparison->missing > 2900);
    CHECK(report.comparison->first.size() == 10);
}

TEST_CASE_METHOD(Fixture, "an attribute the file lacks is a fault", "[verify]") {
    writeScan(surfaceScan(1, 3000, 1), folder / "plain.las");
    convertOrFail({folder / "plain.las"}, altered);
    VerifyReport report = verify({scan});
    CHECK_FALSE(report.passed());
    REQUIRE(report.faultCount == 3);
    CHECK(report.faults[0].find("Red") != std::string::npos);
}

TEST_CASE_METHOD(Fixture, "text is compared as the columns and grid step say", "[verify]") {
    std::string text = folder / "points.txt";
    std::ofstream(text) << "7 1.26 2.5 100\n9 2.74 3.5 200\n";
    ConvertOptions options;
    options.input = {"classification,x,y,z", 0.5};
    convertOrFail({text}, altered, options);
    auto same = verifyFile(altered, {text}, 1, nullptr, noProgress, options.input);
    REQUIRE(same.ok());
    CHECK(same->passed());
    CHECK(same->comparison->equalPoints == 2);
    CHECK_FALSE(verify({text}).passed()); // as x y z intensity
}

TEST_CASE_METHOD(Fixture, "every flipped byte of a node is found", "[verify]") {
    Bytes bytes = fileBytes(cloud);
    std::mt19937_64 random(1);
    for (int i = 0; i < 60; ++i) {
        Bytes damaged = bytes;
        std::size_t at = random() % bytes.size();
        damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ (1u << random() % 8));
        std::ofstream(altered, std::ios::binary)
            .write(reinterpret_cast<const char*>(damaged.data()),
                   static_cast<std::streamsize>(damaged.size()));
        auto report = verifyFile(altered, {}, 1, nullptr, noProgress);
        INFO("byte " << at);
        CHECK((!report.ok() || !report->passed()));
        for (const std::string& fault : report.ok() ? report->faults : std::vector<std::string>{}) {
            INFO(fault);
            CHECK(fault.find("node ") == fault.rfind("node ")); // placed once
        }
    }
}

TEST_CASE("points nearer than the spacing are a fault", "[verify]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 200000, 4), folder / "in.las");
    convertOrFail({folder / "in.las"}, folder / "c.stipple");
    rewrite(folder / "c.stipple", folder / "altered.stipple",
            [](const CloudMetadata&, const NodeEntry& entry, PointBatch& batch) {
                if (entry.key.level == 0)
                    batch.positions[1] = batch.positions[0];
            });
    auto report = verifyFile(folder / "altered.stipple", {}, 2, nullptr, noProgress);
    REQUIRE(report.ok());
    CHECK(report->tooNear == 1);
    CHECK_FALSE(report->passed());
}
