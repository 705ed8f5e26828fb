#include "shared/io/memory_source.hpp"
#include "tests/unit/shared/codec/damage.hpp"
#include "tests/unit/shared/format/sample_file.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {

// Every point of the file, or the first error.
Result<PointHash> readAll(const Bytes& bytes) {
    MemorySource source(bytes);
    STIPPLE_TRY(reader, CloudReader::open(source));
    PointHash hash;
    STIPPLE_CHECK(reader->visitNodes([&](const NodeEntry& entry) -> Status {
        STIPPLE_TRY(points, reader->readNode(entry));
        hash.add(reader->metadata().schema, points);
        return {};
    }));
    return hash;
}

} // namespace

TEST_CASE("a truncated or altered file is an error, wherever the damage is") {
    SampleFile file = sampleFile(400);
    PointHash right = need(readAll(file.bytes));
    CHECK(right == file.hash);
    int damagedFiles = 0;
    forEachDamage(file.bytes, 3000, [&](const Bytes& damaged) {
        if (damaged == file.bytes)
            return;
        ++damagedFiles;
        if (auto read = readAll(damaged); read.ok())
            FAIL("damage went unnoticed");
    });
    CHECK(damagedFiles > 3000);
}

TEST_CASE("a file that was cut says how many bytes it should have") {
    SampleFile file = sampleFile(400);
    std::size_t whole = file.bytes.size();
    file.bytes.resize(whole - 1);
    auto read = readAll(file.bytes);
    REQUIRE(!read.ok());
    CHECK(read.error().code == ErrorCode::truncated);
    CHECK(read.error().what.find(std::to_string(whole)) != std::string::npos);
}
