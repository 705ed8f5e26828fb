#include "tests/unit/converter/input/e57/read_all.hpp"

#include "converter/input/e57/crc32c.hpp"
#include "shared/base/text.hpp"
#include "tests/support/data.hpp"
#include "tests/support/mutate.hpp"

using namespace stipple;
using namespace stipple::test;
using Catch::Matchers::Contains;

namespace {
E57File smallFile() {
    E57Scan scan;
    std::vector<float> values;
    std::vector<std::int64_t> integers;
    for (int i = 0; i < 150; ++i) {
        values.push_back(static_cast<float>(i) * 0.37f);
        integers.push_back(i * 7 % 150);
    }
    scan.fields = {floatField("cartesianX", values),
                   scaledField("cartesianY", 0, 150, "0.01", "0", integers),
                   doubleField("cartesianZ", std::vector<double>(150, 1.5)),
                   integerField("cartesianInvalidState", 0, 2, std::vector<std::int64_t>(150, 0)),
                   integerField("intensity", 0, 4095, integers),
                   floatField("ext:a", values)};
    scan.bytesPerPacket = 200;
    scan.emptyPackets = true;
    scan.recordsPerRestart = 60;
    scan.xml = "<pose><rotation><w>1</w><x>0.1</x></rotation><translation><x>5</x></translation></pose>";
    return {{scan, scan}, "<coordinateMetadata type=\"String\"/>"};
}

E57File withXml(E57Scan scan, const std::string& from, const std::string& to) {
    for (E57Field& field : scan.fields)
        if (std::size_t at = field.xml.find(from); at != std::string::npos)
            field.xml.replace(at, from.size(), to);
    return {{scan}, ""};
}
E57Scan tinyScan() {
    E57Scan scan;
    for (const char* name : {"cartesianX", "cartesianY", "cartesianZ"})
        scan.fields.push_back(scaledField(name, 0, 100, "0.5", "0", {1, 2, 3}));
    return scan;
}
} // namespace

TEST_CASE("CRC-32C by instruction and by table are the definition's") {
    Bytes check{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
    CHECK(e57::crc32c(check) == 0xE3069283u); // the check value of the Castagnoli polynomial
    Bytes bytes;
    for (int i = 0; i < 70; ++i) {
        CHECK(e57::crc32c(bytes) == slowCrc32c(bytes));
        CHECK(e57::crc32cByTable(bytes) == slowCrc32c(bytes));
        bytes.push_back(static_cast<std::uint8_t>(i * 37 + 11));
    }
}

TEST_CASE("a page with a wrong checksum is reported with its number and byte") {
    Bytes file = smallFile().bytes();
    for (std::size_t page = 0; page < file.size() / 1024; ++page)
        for (std::size_t at : {std::size_t{100}, std::size_t{1023}}) {
            Bytes damaged = file;
            damaged[page * 1024 + at] = static_cast<std::uint8_t>(damaged[page * 1024 + at] ^ 4);
            Error error = e57Error(damaged);
            CHECK(error.code == ErrorCode::corrupt);
            CHECK_THAT(error.what, Contains(cat("checksum of page ", page, " ")));
            CHECK_THAT(error.where, Contains(cat("byte ", page * 1024)));
        }
}

TEST_CASE("every truncation is an error") {
    TemporaryFolder folder;
    std::string path = folder.file("a.e57");
    Bytes file = smallFile().bytes();
    writeBytes(path, file);
    for (std::size_t size = file.size() - 1; size > 0;
         size -= std::min<std::size_t>(size, size > 1100 ? 61 : 5)) {
        std::filesystem::resize_file(path, size);
        auto read = readE57(path);
        REQUIRE(!read);
        CHECK(read.error().code == ErrorCode::truncated);
    }
}

TEST_CASE("every truncation whose header admits it is an error, or ends before a scan's last record") {
    Bytes file = smallFile().bytes();
    for (std::size_t pages = 1; pages < file.size() / 1024; ++pages) {
        Bytes cut(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(pages * 1024));
        storeLe<std::uint64_t>(cut.data() + 16, cut.size());
        mendE57Checksums(cut);
        CHECK(!e57Error(cut).sentence().empty());
    }
}

namespace {
// Every `step`-th byte of the file, damaged in turn.
void tryCorruptedBytes(std::size_t step, std::initializer_list<int> flips) {
    TemporaryFolder folder;
    const Bytes file = smallFile().bytes();
    std::size_t refused = 0, tried = 0;
    for (std::size_t at = 0; at < file.size(); at += step)
        for (int flip : flips) {
            Bytes damaged = file;
            damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ flip);
            mendE57Checksums(damaged);
            auto read = readE57(writeBytes(folder.file("a.e57"), damaged));
            if (!read)
                CHECK(!read.error().sentence().empty());
            refused += read ? 0 : 1;
            ++tried;
        }
    CHECK(refused > tried / 20);
}
} // namespace

TEST_CASE("a corrupted byte under a right checksum is an error or gives points") {
    tryCorruptedBytes(23, {0xFF});
}
TEST_CASE("every corrupted byte under a right checksum is an error or gives points", "[slow]") {
    tryCorruptedBytes(1, {0x01, 0x80, 0xFF});
}

TEST_CASE("damage of every kind under right checksums is an error or gives points") {
    TemporaryFolder folder;
    Bytes file = smallFile().bytes();
    for (std::uint64_t seed = 0; seed < 500; ++seed) {
        Mutation mutation = mutate(file, seed);
        if (mutation.bytes.size() >= 48) // so that more than the stated length is tried
            storeLe<std::uint64_t>(mutation.bytes.data() + 16, mutation.bytes.size() / 1024 * 1024);
        mendE57Checksums(mutation.bytes);
        auto read = readE57(writeBytes(folder.file("a.e57"), mutation.bytes));
        if (!read)
            CHECK(!read.error().sentence().empty());
    }
}

TEST_CASE("what can't be read is said in a sentence") {
    E57File none{{}, ""};
    CHECK_THAT(e57Error(none).sentence(), Contains("no scan with points (data3D is empty)"));
    none.rootXml = "<images2D><vectorChild/></images2D>";
    CHECK_THAT(e57Error(none).sentence(), Contains("only 1 pictures"));

    E57Scan scan = tinyScan();
    scan.fields.pop_back();
    CHECK_THAT(e57Error(E57File{{scan}, ""}).sentence(), Contains("no cartesianZ"));
    scan.fields = {integerField("rowIndex", 0, 3, {1})};
    CHECK_THAT(e57Error(E57File{{scan}, ""}).sentence(), Contains("no coordinates"));
    CHECK_THAT(e57Error(E57File{{scan}, ""}).where, Contains("scan 1"));

    scan = tinyScan();
    scan.codecs = "<codecs><vectorChild><inputs/><ext:fancyCodec/></vectorChild></codecs>";
    CHECK_THAT(e57Error(E57File{{scan}, ""}).sentence(), Contains("codec \"ext:fancyCodec\""));

    scan = tinyScan();
    scan.claimedRecords = 4000000000000;
    Error error = e57Error(E57File{{scan}, ""});
    CHECK_THAT(error.sentence(), Contains("of 4000000000000 records"));
    scan.claimedRecords = 9000000000000000000;
    CHECK_THAT(e57Error(E57File{{scan}, ""}).sentence(), Contains("no file can hold"));

    scan.fields = {integerField("cartesianX", 5, 5, {5}), integerField("cartesianY", 5, 5, {5}),
                   integerField("cartesianZ", 5, 5, {5})};
    scan.claimedRecords = 4000000000000;
    CHECK_THAT(e57Error(E57File{{scan}, ""}).sentence(), Contains("no bytes at all"));

    CHECK_THAT(e57Error(withXml(tinyScan(), "maximum=\"100\"", "maximum=\"ten\"")).sentence(),
               Contains("maximum \"ten\" is no number"));
    CHECK_THAT(e57Error(withXml(tinyScan(), "maximum=\"100\"", "maximum=\"-1\"")).sentence(),
               Contains("maximum is less"));
    CHECK_THAT(e57Error(withXml(tinyScan(), "ScaledInteger", "Blob")).sentence(), Contains("type \"Blob\""));
    CHECK_THAT(e57Error(withXml(tinyScan(), "cartesianY", "cartesianX")).sentence(),
               Contains("two fields of this name"));
    // One stream fewer than there are fields.
    CHECK_THAT(e57Error(withXml(tinyScan(), "<cartesianZ", "<b/><cartesianZ")).sentence(),
               Contains("type \"\""));
}

TEST_CASE("a file that is another one than when it was opened is refused") {
    TemporaryFolder folder;
    E57File file = smallFile();
    std::string path = writeBytes(folder.file("a.e57"), file.bytes());
    auto input = openE57Input(path);
    REQUIRE(input.ok());
    auto first = (*input)->openPart(0); // takes the one that was open
    REQUIRE(first.ok());
    file.scans[0].xml = "<name>another</name>";
    writeBytes(path, file.bytes());
    auto second = (*input)->openPart(0);
    REQUIRE(!second.ok());
    CHECK(second.error().code == ErrorCode::changed);
}

TEST_CASE("opening and reading a file end when they are told to stop") {
    TemporaryFolder folder;
    std::string path = writeBytes(folder.file("a.e57"), smallFile().bytes());
    std::atomic<bool> stop{true};
    auto refused = openE57Input(path, {.stop = &stop});
    REQUIRE(!refused.ok());
    CHECK(refused.error().code == ErrorCode::cancelled);
    stop = false;
    auto input = openE57Input(path, {.stop = &stop});
    REQUIRE(input.ok());
    auto stream = (*input)->openPart(0);
    REQUIRE(stream.ok());
    stop = true;
    PointBatch batch;
    Status read = (*stream)->next(batch);
    REQUIRE(!read.ok());
    CHECK(read.error().code == ErrorCode::cancelled);
}

TEST_CASE("E57 files of other programs are read, and the damaged one is refused") {
    STIPPLE_NEEDS_DATA();
    auto bunny = readE57(dataPath("other/bunnyInt32.e57"));
    REQUIRE(bunny.ok());
    CHECK(bunny->points.size() == 30571);
    CHECK(bunny->report.maxRounding == 0);
    CHECK(bunny->description.bounds.min == Vec3i{-94689, 40011, -61873});
    CHECK(bunny->description.bounds.max == Vec3i{61009, 187321, 58799});

    auto cube = readE57(dataPath("other/ColouredCubeFloat.e57"));
    REQUIRE(cube.ok());
    CHECK(cube->points.size() == 7680);
    for (Vec3d p : cube->world())
        CHECK(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= 0.5);

    auto two = readE57(dataPath("other/A_B.e57"));
    REQUIRE(two.ok());
    CHECK(two->values<std::uint16_t>("Point Source ID") == std::vector<std::uint16_t>{1, 1, 2, 2, 2, 2});
    CHECK(std::abs(two->description.grid.toWorld(two->description.bounds.min).x + 44.952201843261719) < 1e-5);
    CHECK(readE57(dataPath("other/A4_moved.e57")).ok());

    auto bad = readE57(dataPath("other/bad-crc.e57"));
    REQUIRE(!bad.ok());
    CHECK_THAT(bad.error().sentence(), Contains("byte 0: the checksum of page 0 is 1392E413"));
}
