#include "shared/format/file_parts.hpp"
#include "tests/unit/shared/format/sample_cloud.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {
Bytes sampleHeader() {
    return writeFileHeader({123456, {64, 2000}, {2064, 300}});
}
} // namespace

TEST_CASE("the header comes back") {
    FileHeader header = need(parseFileHeader(sampleHeader()));
    CHECK(header.fileBytes == 123456);
    CHECK(header.metadata == ByteRange{64, 2000});
    CHECK(header.rootChunk == ByteRange{2064, 300});
}

TEST_CASE("a truncated header says how many bytes there are") {
    Bytes bytes = sampleHeader();
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        auto read = parseFileHeader(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)));
        REQUIRE(!read.ok());
        CHECK(read.error().code == ErrorCode::truncated);
        CHECK(read.error().what.find(std::to_string(size) + " of 64") != std::string::npos);
    }
}

TEST_CASE("a header with any bit altered is refused") {
    Bytes bytes = sampleHeader();
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        Bytes altered = bytes;
        altered[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
        CHECK(!parseFileHeader(altered).ok());
    }
}

TEST_CASE("other files and other versions are refused in a sentence") {
    CHECK(parseFileHeader(Bytes(64, 'x')).error().what == "this is no .stipple file");
    Bytes bytes = sampleHeader();
    bytes[8] = 3;
    auto newer = parseFileHeader(bytes);
    CHECK(newer.error().code == ErrorCode::unsupported);
    CHECK(newer.error().what == "the file has format version 3; this program reads versions 1 to 2");
}

TEST_CASE("both versions are read, but no mean colours in the first") {
    CloudMetadata metadata = sampleMetadata();
    for (InnerColour colour : {InnerColour::exact, InnerColour::mean}) {
        metadata.innerColour = colour;
        FileHeader header{123456, {64, 2000}, {2064, 300}, versionFor(metadata)};
        header = need(parseFileHeader(writeFileHeader(header)));
        CHECK(header.version == (colour == InnerColour::mean ? 2 : 1));
        CHECK(checkVersion(header, metadata).ok());
    }
    CHECK(checkVersion(need(parseFileHeader(sampleHeader())), metadata).error().code == ErrorCode::corrupt);
}

TEST_CASE("parts outside the file are refused") {
    for (FileHeader header :
         {FileHeader{100, {64, 40}, {70, 10}}, FileHeader{100, {10, 5}, {70, 10}},
          FileHeader{1000, {64, 10}, {UINT64_MAX - 5, 10}}, FileHeader{1000, {64, UINT64_MAX}, {74, 10}}})
        CHECK(parseFileHeader(writeFileHeader(header)).error().code == ErrorCode::corrupt);
}
