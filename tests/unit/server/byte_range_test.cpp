#include "server/http/byte_range.hpp"

#include "shared/base/text.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::server;

namespace {

// "206 0+10 20+5", "200" (whole), "416" (unsatisfiable) or "refused".
std::string resolved(const std::string& field, std::uint64_t sizeBytes) {
    ResolvedRanges ranges = resolveRanges(field, sizeBytes);
    switch (ranges.kind) {
    case RangeAnswerKind::whole:
        return "200";
    case RangeAnswerKind::unsatisfiable:
        return "416";
    case RangeAnswerKind::refused:
        return "refused";
    case RangeAnswerKind::parts:
        break;
    }
    std::string text = "206";
    for (const ByteRange& part : ranges.parts)
        text += cat(" ", part.offset, "+", part.size);
    return text;
}

constexpr std::uint64_t large = std::uint64_t{1} << 40;

} // namespace

TEST_CASE("a single range is cut at the end of the file") {
    CHECK(resolved("bytes=0-9", 100) == "206 0+10");
    CHECK(resolved("bytes=0-0", 100) == "206 0+1");
    CHECK(resolved("bytes=99-99", 100) == "206 99+1");
    CHECK(resolved("bytes=90-1000", 100) == "206 90+10");
    CHECK(resolved("bytes=10-", 100) == "206 10+90");
    CHECK(resolved("bytes=0-", 100) == "206 0+100");
}

TEST_CASE("a suffix range is the end of the file, or all of it") {
    CHECK(resolved("bytes=-1", 100) == "206 99+1");
    CHECK(resolved("bytes=-100", 100) == "206 0+100");
    CHECK(resolved("bytes=-101", 100) == "206 0+100");
    CHECK(resolved("bytes=-0", 100) == "416");
}

TEST_CASE("a range beyond the end, and every range of an empty file, is unsatisfiable") {
    CHECK(resolved("bytes=100-", 100) == "416");
    CHECK(resolved("bytes=100-200", 100) == "416");
    CHECK(resolved("bytes=0-", 0) == "416");
    CHECK(resolved("bytes=0-0", 0) == "416");
    CHECK(resolved("bytes=-5", 0) == "416");
}

TEST_CASE("numbers around 2^31, 2^32, 2^63 and 2^64 never wrap") {
    CHECK(resolved("bytes=2147483647-2147483648", large) == "206 2147483647+2");
    CHECK(resolved("bytes=4294967295-4294967296", large) == "206 4294967295+2");
    CHECK(resolved("bytes=0-9223372036854775807", large) == "206 0+1099511627776");
    CHECK(resolved("bytes=0-9223372036854775808", large) == "206 0+1099511627776");
    CHECK(resolved("bytes=0-18446744073709551615", large) == "206 0+1099511627776");
    CHECK(resolved("bytes=0-18446744073709551616", large) == "206 0+1099511627776");
    CHECK(resolved("bytes=1-99999999999999999999999999999999", large) == "206 1+1099511627775");
    CHECK(resolved("bytes=9223372036854775808-", large) == "416");
    CHECK(resolved("bytes=18446744073709551615-", large) == "416");
    CHECK(resolved("bytes=18446744073709551616-", large) == "416");
    CHECK(resolved("bytes=18446744073709551616-18446744073709551617", large) == "416");
    CHECK(resolved("bytes=-18446744073709551616", large) == "206 0+1099511627776");
    std::uint64_t huge = ~std::uint64_t{0};
    CHECK(resolved("bytes=18446744073709551614-18446744073709551615", huge) == "206 18446744073709551614+1");
    CHECK(resolved("bytes=0-0,18446744073709551614-", huge) == "206 0+1 18446744073709551614+1");
}

TEST_CASE("a last position before the first is malformed, however many digits both have") {
    CHECK(resolved("bytes=5-4", large) == "refused");
    CHECK(resolved("bytes=18446744073709551617-18446744073709551616", large) == "refused");
    CHECK(resolved("bytes=00018-9", large) == "refused");
    CHECK(resolved("bytes=0009-18", large) == "206 9+10");
}

TEST_CASE("a malformed range is ignored on a small file and refused on a large one") {
    for (const char* field :
         {"bytes", "bytes 0-9", "nonsense", "bytes=", "bytes=,", "bytes=a-b", "bytes=1", "bytes=-",
          "bytes=--1", "bytes=1--2", "bytes=1-2-3", "bytes=0x10-20", "bytes=+1-2", "bytes=1 -2", "bytes=0-1;",
          "bytes=1.5-2", "bytes=0-1, x", "bytes=\xEF\xBC\x91-"}) {
        INFO(field);
        CHECK(resolved(field, ignoreBadRangeUpToBytes) == "200");
        CHECK(resolved(field, ignoreBadRangeUpToBytes + 1) == "refused");
    }
}

TEST_CASE("no Range and unknown units mean the whole file") {
    CHECK(resolved("", large) == "200");
    CHECK(resolved("lines=1-2", large) == "200");
    CHECK(resolved("BYTES=0-1", large) == "206 0+2");
}

TEST_CASE("several ranges keep their order when they are apart") {
    CHECK(resolved("bytes=5000-5009, 0-9", large) == "206 5000+10 0+10");
    CHECK(resolved("bytes=0-9,,\t5000-5009,", large) == "206 0+10 5000+10");
    CHECK(resolved("bytes=0-0,-1", 10'000) == "206 0+1 9999+1");
}

TEST_CASE("ranges that overlap, touch or nearly touch are merged") {
    CHECK(resolved("bytes=0-9,5-14", large) == "206 0+15");
    CHECK(resolved("bytes=0-9,10-19", large) == "206 0+20");
    CHECK(resolved("bytes=0-9,0-9,0-9", large) == "206 0+10");
    CHECK(resolved("bytes=100-199,0-9", large) == "206 0+200");
    CHECK(resolved("bytes=0-9,137-140", large) == "206 0+141");
    CHECK(resolved("bytes=0-9,138-140", large) == "206 0+10 138+3");
    CHECK(resolved("bytes=0-99,10-20,5000-5000", large) == "206 0+100 5000+1");
}

TEST_CASE("an unsatisfiable range among satisfiable ones is left out") {
    CHECK(resolved("bytes=0-9,200-300", 100) == "206 0+10");
    CHECK(resolved("bytes=200-300,-0", 100) == "416");
}

TEST_CASE("many tiny ranges are limited") {
    auto many = [](std::size_t count) {
        std::string field = "bytes=";
        for (std::size_t i = 0; i < count; ++i)
            field += cat(i > 0 ? "," : "", i * 1000, "-", i * 1000);
        return field;
    };
    CHECK(resolveRanges(many(maxRangesInRequest), large).parts.size() == maxRangesInRequest);
    CHECK(resolved(many(maxRangesInRequest + 1), large) == "refused");
    CHECK(resolved(many(maxRangesInRequest + 1), 1000) == "200");
}

TEST_CASE("Content-Range names first and last byte and the size") {
    CHECK(contentRange({0, 10}, 100) == "bytes 0-9/100");
    CHECK(unsatisfiedRange(0) == "bytes */0");
}
