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

// So little memory that points go to disk and cells of more than some 100 points are parted.
VerifyOptions tight(std::atomic<std::uint64_t>& temporaryBytes, const std::string& temp) {
    VerifyOptions options;
    options.threads = 3;
    options.memoryBytes = 1 << 17;
    options.temp = temp;
    options.temporaryBytes = &temporaryBytes;
    return options;
}

VerifyReport verifyOrFail(const std::string& cloud, const std::vector<std::string>& inputs,
                          const VerifyOptions& options) {
    auto report = verifyFile(cloud, inputs, options, noProgress);
    if (!report)
        FAIL(report.error().sentence());
    return std::move(report).value();
}

struct Fixture {
    TemporaryFolder folder;
    std::string scan = folder / "in.las", cloud = folder / "c.stipple", altered = folder / "altered.stipple";

    Fixture() {
        writeScan(surfaceScan(3, 3000, 1), scan);
        convertOrFail({scan}, cloud);
    }
    VerifyReport verify(const std::vector<std::string>& inputs) {
        auto report = verifyFile(altered, inputs, {.threads = 1}, noProgress);
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
    CHECK(report.comparison->first[0].text.find("GPS Time is ") != std::string::npos);
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
    auto same = verifyFile(altered, {text}, {.threads = 1, .reading = options.input}, noProgress);
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
        auto report = verifyFile(altered, {}, {.threads = 1}, noProgress);
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
    auto report = verifyFile(folder / "altered.stipple", {}, {.threads = 2}, noProgress);
    REQUIRE(report.ok());
    CHECK(report->tooNear == 1);
    CHECK_FALSE(report->passed());
}

TEST_CASE("more points than memory holds are compared all the same", "[verify]") {
    TemporaryFolder folder;
    std::filesystem::create_directory(folder / "temp");
    std::atomic<std::uint64_t> temporaryBytes{0};
    VerifyOptions options = tight(temporaryBytes, folder / "temp");
    TestScan surface = surfaceScan(3, 60000, 1), cluster = surfaceScan(3, 30000, 2),
             equal = surfaceScan(3, 20000, 3);
    for (Vec3i& p : cluster.points.positions)
        p = {40000 + p.x % 50, 30000 + p.y % 50, 100 + p.z % 50};
    for (Vec3i& p : equal.points.positions)
        p = {12345, 23456, 300};
    std::fill(equal.points.columns[0].begin(), equal.points.columns[0].end(), std::uint8_t{0});
    std::vector<std::string> inputs;
    for (const TestScan* scan : {&surface, &cluster, &equal}) {
        inputs.push_back(folder / (std::to_string(inputs.size()) + ".las"));
        writeScan(*scan, inputs.back());
    }
    convertOrFail(inputs, folder / "c.stipple");
    VerifyReport whole = verifyOrFail(folder / "c.stipple", inputs, options);
    CHECK(whole.passed());
    CHECK(whole.comparison->equalPoints == 110000);
    CHECK(temporaryBytes > 1000000);

    // What is wrong is found as with all memory there is, point by point.
    rewrite(folder / "c.stipple", folder / "altered.stipple",
            [](const CloudMetadata& metadata, const NodeEntry& entry, PointBatch& batch) {
                int time = metadata.schema.find("GPS Time");
                for (std::size_t i = 0; i < batch.size(); i += 97)
                    batch.setValue<double>(time, i, -batch.value<double>(time, i) - 1);
                if (entry.key.level == 1)
                    removeLast(metadata.schema, batch);
                else
                    doubleLast(metadata.schema, batch);
            });
    VerifyReport altered = verifyOrFail(folder / "altered.stipple", inputs, options);
    VerifyReport roomy = verifyOrFail(folder / "altered.stipple", inputs, {.threads = 1});
    CHECK_FALSE(altered.passed());
    CHECK(altered.comparison->changed > 1000);
    CHECK(altered.comparison->changed == roomy.comparison->changed);
    CHECK(altered.comparison->changedPerAttribute == roomy.comparison->changedPerAttribute);
    CHECK(altered.comparison->missing == roomy.comparison->missing);
    CHECK(altered.comparison->surplus == roomy.comparison->surplus);
    CHECK(altered.comparison->equalPoints == roomy.comparison->equalPoints);
    REQUIRE(altered.comparison->first.size() == 10);
    for (std::size_t i = 0; i < 10; ++i)
        CHECK(altered.comparison->first[i].text == roomy.comparison->first[i].text);
    CHECK(std::filesystem::is_empty(folder / "temp")); // nothing has a name there
}

TEST_CASE("a cloud of equal points is compared in little memory, with their number", "[verify]") {
    TemporaryFolder folder;
    std::atomic<std::uint64_t> temporaryBytes{0};
    TestScan scan = surfaceScan(0, 30000, 1);
    for (std::size_t i = 0; i < 30000; ++i) {
        scan.points.positions[i] = {7, 8, 9};
        for (std::size_t a = 0; a < scan.schema.attributes.size(); ++a)
            scan.points.columns[a] = Bytes(scan.points.columns[a].size(), 1);
    }
    writeScan(scan, folder / "in.las");
    convertOrFail({folder / "in.las"}, folder / "c.stipple");
    VerifyOptions options = tight(temporaryBytes, "");
    CHECK(verifyOrFail(folder / "c.stipple", {folder / "in.las"}, options).passed());
    scan.points.resize(scan.schema, 29998);
    writeScan(scan, folder / "fewer.las");
    VerifyReport report = verifyOrFail(folder / "c.stipple", {folder / "fewer.las"}, options);
    CHECK(report.comparison->surplus == 2);
    CHECK(report.comparison->equalPoints == 29998);
    REQUIRE(report.comparison->first.size() == 1);
    CHECK(report.comparison->first[0].text.find("(2 times)") != std::string::npos);
}

TEST_CASE_METHOD(Fixture, "points of the inputs far from the file's cube are missing in it", "[verify]") {
    TestScan far = surfaceScan(3, 3000, 1);
    far.grid.offset.x -= 4e7; // 4 × 10^9 steps: beyond 32 bits
    writeScan(far, folder / "far.las");
    altered = cloud;
    VerifyReport report = verify({scan, folder / "far.las"});
    CHECK_FALSE(report.passed());
    CHECK(report.comparison->equalPoints == 3000);
    CHECK(report.comparison->missing == 3000);
    CHECK(report.comparison->inputPoints == 6000);
    REQUIRE(report.comparison->first.size() == 10);
    CHECK(report.comparison->first[0].text.find("a point of the inputs is not in the file") !=
          std::string::npos);
}

TEST_CASE_METHOD(Fixture, "no room for what memory does not hold is an error that names the folder",
                 "[verify]") {
    writeScan(surfaceScan(3, 60000, 1), folder / "large.las");
    convertOrFail({folder / "large.las"}, altered);
    std::atomic<std::uint64_t> temporaryBytes{0};
    auto report =
        verifyFile(altered, {folder / "large.las"}, tight(temporaryBytes, folder / "none"), noProgress);
    REQUIRE_FALSE(report.ok());
    CHECK(report.error().code == ErrorCode::writeFailed);
    CHECK(report.error().sentence().find(folder / "none") != std::string::npos);
    VerifyOptions roomy;
    roomy.temp = folder / "none"; // never asked for
    CHECK(verifyOrFail(altered, {folder / "large.las"}, roomy).passed());
}

TEST_CASE_METHOD(Fixture, "a comparison that is stopped says so and leaves nothing", "[verify]") {
    std::atomic<bool> stop{false};
    std::atomic<std::uint64_t> temporaryBytes{0};
    VerifyOptions options = tight(temporaryBytes, "");
    options.stop = &stop;
    for (const char* phase : {"tile", "verify"}) {
        stop = false;
        auto report =
            verifyFile(cloud, {scan}, options, [&](const std::string& now, std::uint64_t, std::uint64_t) {
                stop = stop || now == phase;
            });
        REQUIRE_FALSE(report.ok());
        CHECK(report.error().code == ErrorCode::cancelled);
    }
    CHECK(folder.files() == 2);
}

namespace {
// The points of a PLY file as LAS must have them: an intensity and so on that nobody measured.
TestScan emptyFields(std::size_t count) {
    TestScan scan = surfaceScan(2, count, 5);
    for (Bytes& column : scan.points.columns)
        std::fill(column.begin(), column.end(), std::uint8_t{0});
    return scan;
}
void writeText(const TestScan& scan, const std::string& path) {
    std::ofstream text(path);
    text.precision(12);
    for (Vec3i p : scan.points.positions) {
        Vec3d world = scan.grid.toWorld(p);
        text << world.x << ' ' << world.y << ' ' << world.z << '\n';
    }
}
} // namespace

TEST_CASE("fields that LAS can't leave out are no difference while they are 0", "[verify]") {
    TemporaryFolder folder;
    TestScan scan = emptyFields(500);
    writeText(scan, folder / "points.txt");
    writeScan(scan, folder / "points.las");
    convertOrFail({folder / "points.txt"}, folder / "text.stipple");
    convertOrFail({folder / "points.las"}, folder / "las.stipple");

    VerifyReport report = verifyOrFail(folder / "text.stipple", {folder / "points.las"}, {});
    CHECK(report.passed());
    CHECK(report.comparison->equalPoints == 500);
    REQUIRE(report.notes.size() == 1);
    CHECK(report.notes[0].find("Intensity, Return Number, ") != std::string::npos);
    CHECK(report.notes[0].find("format can't leave out") != std::string::npos);

    report = verifyOrFail(folder / "las.stipple", {folder / "points.txt"}, {});
    CHECK(report.passed());
    REQUIRE(report.notes.size() == 1);
    CHECK(report.notes[0].find("compared with 0: Intensity, ") != std::string::npos);

    // One value is enough to make it one.
    int red = scan.schema.find("Red");
    scan.points.setValue<std::uint16_t>(red, 499, 256);
    writeScan(scan, folder / "points.las");
    convertOrFail({folder / "points.las"}, folder / "las.stipple");
    report = verifyOrFail(folder / "text.stipple", {folder / "points.las"}, {});
    CHECK_FALSE(report.passed());
    REQUIRE(report.faults.size() == 1);
    CHECK(report.faults[0] == "the inputs' attribute Red holds values, but is missing in the file");
    report = verifyOrFail(folder / "las.stipple", {folder / "points.txt"}, {});
    CHECK_FALSE(report.passed());
    CHECK(report.comparison->changed == 1);
}

TEST_CASE("attributes that an input need not have are missed, whatever their value", "[verify]") {
    TemporaryFolder folder;
    std::ofstream(folder / "with.ply") << "ply\nformat ascii 1.0\nelement vertex 2\nproperty int x\nproperty "
                                          "int y\nproperty int z\nproperty uchar quality\nend_header\n"
                                          "1 2 3 0\n4 5 6 0\n";
    std::ofstream(folder / "without.ply") << "ply\nformat ascii 1.0\nelement vertex 2\nproperty int x\n"
                                             "property int y\nproperty int z\nend_header\n1 2 3\n4 5 6\n";
    convertOrFail({folder / "without.ply"}, folder / "c.stipple");
    VerifyReport report = verifyOrFail(folder / "c.stipple", {folder / "with.ply"}, {});
    CHECK_FALSE(report.passed());
    REQUIRE(report.faults.size() == 1);
    CHECK(report.faults[0].find("quality") != std::string::npos);

    // An extra byte of a LAS file is no field of its point format.
    TestScan scan = emptyFields(100);
    writeScan(scan, folder / "plain.las");
    scan.schema.attributes.push_back({"extra", AttributeType::u8});
    scan.points.columns.push_back(Bytes(100, 0));
    writeScan(scan, folder / "extra.las");
    convertOrFail({folder / "plain.las"}, folder / "p.stipple");
    report = verifyOrFail(folder / "p.stipple", {folder / "extra.las"}, {});
    CHECK_FALSE(report.passed());
    REQUIRE(report.faults.size() == 1);
    CHECK(report.faults[0].find("extra") != std::string::npos);
}
