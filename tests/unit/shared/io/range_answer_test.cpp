#include "shared/io/range_answer.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

namespace {

constexpr const char* where = "http://host/town.stipple";

RangeAnswer part(const std::string& contentRange, const std::string& etag = "\"v1\"") {
    return {206, contentRange, etag, "", std::nullopt};
}

ErrorCode codeOf(ByteRange asked, const RangeAnswer& answer, FileVersion version = {}) {
    auto judged = judgeRangeAnswer(asked, answer, version, where);
    REQUIRE_FALSE(judged.ok());
    CHECK(judged.error().where == where);
    return judged.error().code;
}

const FileVersion pinned{"\"v1\"", "", 1000, true};

} // namespace

TEST_CASE("a range field names the first and the last byte") {
    CHECK(rangeField({0, 65536}) == "bytes=0-65535");
    CHECK(rangeField({std::uint64_t{1} << 52, 1}) == "bytes=4503599627370496-4503599627370496");
}

TEST_CASE("a part that is what was asked for is read, and pins the version") {
    FileVersion version;
    auto judged = judgeRangeAnswer({100, 50}, part("bytes 100-149/1000"), version, where);
    REQUIRE(judged.ok());
    CHECK(*judged == 50);
    CHECK(version.pinned);
    CHECK(version.sizeBytes == 1000);
    CHECK(version.etag == "\"v1\"");
}

TEST_CASE("a part is cut at the end of the file and nowhere else") {
    FileVersion version;
    auto judged = judgeRangeAnswer({900, 500}, part("bytes 900-999/1000"), version, where);
    REQUIRE(judged.ok());
    CHECK(*judged == 100);
    CHECK(codeOf({100, 50}, part("bytes 100-120/1000")) == ErrorCode::networkFailed);
    CHECK(codeOf({100, 50}, part("bytes 100-120/*")) == ErrorCode::networkFailed);
}

TEST_CASE("a part of unknown total size is read when it has the size asked for") {
    FileVersion version;
    auto judged = judgeRangeAnswer({100, 50}, part("bytes 100-149/*"), version, where);
    REQUIRE(judged.ok());
    CHECK(version.sizeBytes == 0);
}

TEST_CASE("another part than the one asked for is refused") {
    for (const char* range :
         {"bytes 0-49/1000", "bytes 101-150/1000", "bytes 100-150/1000", "bytes 100-149/120",
          "bytes 149-100/1000", "bytes 100-149", "bytes 100-149/1000 ", "bytes */1000", "items 100-149/1000",
          "bytes -100-149/1000", "bytes 18446744073709551616-149/1000", "bytes"})
        CHECK(codeOf({100, 50}, part(range)) == ErrorCode::networkFailed);
}

TEST_CASE("a hidden Content-Range is the host's way at first, and a failure where it was shown before") {
    CHECK(codeOf({100, 50}, part("")) == ErrorCode::unsupported);
    CHECK(codeOf({100, 50}, part(""), pinned) == ErrorCode::networkFailed);
    FileVersion version;
    Error error = judgeRangeAnswer({100, 50}, part(""), version, where).error();
    CHECK(error.advice.find("Access-Control-Expose-Headers: Content-Range, ETag") != std::string::npos);
}

TEST_CASE("versions that are named badly are cautioned of") {
    auto cautions = [](const FileVersion& version, const std::string& of) {
        return versionCaution(version).find(of) != std::string::npos;
    };
    CHECK(versionCaution({}).empty()); // nothing was read yet
    CHECK(versionCaution({"\"1\"", "", 1000, true}).empty());
    CHECK(cautions({"W/\"1\"", "", 1000, true}, "weak ETag"));
    CHECK(cautions({"", "Mon, 01 Jan 2024 00:00:00 GMT", 1000, true}, "but the date"));
    CHECK(cautions({"", "", 1000, true}, "no Last-Modified"));
}

TEST_CASE("a server that ignores Range is recognised before its body is read") {
    CHECK(codeOf({100, 50}, {200, "", "", "", 1000}) == ErrorCode::unsupported);
    CHECK(codeOf({0, 50}, {200, "", "", "", 1000}) == ErrorCode::unsupported);
    CHECK(codeOf({0, 50}, {200, "", "", "", std::nullopt}) == ErrorCode::unsupported);
}

TEST_CASE("a whole file that fits the first range is as good as a part") {
    FileVersion version;
    auto judged = judgeRangeAnswer({0, 65536}, {200, "", "\"v1\"", "", 1000}, version, where);
    REQUIRE(judged.ok());
    CHECK(*judged == 1000);
    CHECK(version.sizeBytes == 1000);
}

TEST_CASE("a replaced file is noticed by ETag, size, date, status or absence") {
    CHECK(codeOf({0, 50}, part("bytes 0-49/1000", "\"v2\""), pinned) == ErrorCode::changed);
    CHECK(codeOf({0, 50}, part("bytes 0-49/1001"), pinned) == ErrorCode::changed);
    CHECK(codeOf({0, 50}, {200, "", "\"v2\"", "", 1000}, pinned) == ErrorCode::changed);
    CHECK(codeOf({900, 50}, {416, "bytes */800", "\"v2\"", "", 0}, pinned) == ErrorCode::changed);
    CHECK(codeOf({0, 50}, {412, "", "", "", 0}, pinned) == ErrorCode::changed);
    CHECK(codeOf({0, 50}, {404, "", "", "", 0}, pinned) == ErrorCode::changed);
    FileVersion dated{"", "Mon, 01 Jan 2024 00:00:00 GMT", 1000, true};
    CHECK(codeOf({0, 50}, {206, "bytes 0-49/1000", "", "Tue, 02 Jan 2024 00:00:00 GMT", 50}, dated) ==
          ErrorCode::changed);
}

TEST_CASE("the same version is read on, also where a validator is hidden") {
    FileVersion version = pinned;
    CHECK(judgeRangeAnswer({0, 50}, part("bytes 0-49/1000"), version, where).ok());
    CHECK(judgeRangeAnswer({0, 50}, part("bytes 0-49/1000", ""), version, where).ok());
    CHECK(version.etag == "\"v1\"");
}

TEST_CASE("absent, past the end, refused and broken stay different things") {
    CHECK(codeOf({0, 50}, {404, "", "", "", 0}) == ErrorCode::notFound);
    CHECK(codeOf({2000, 50}, {416, "bytes */1000", "\"v1\"", "", 0}, pinned) == ErrorCode::truncated);
    CHECK(codeOf({0, 50}, {401, "", "", "", 0}) == ErrorCode::accessDenied);
    CHECK(codeOf({0, 50}, {403, "", "", "", 0}) == ErrorCode::accessDenied);
    CHECK(codeOf({0, 50}, {503, "", "", "", 0}) == ErrorCode::networkFailed);
}

TEST_CASE("a busy server says for how long it wants to be left alone") {
    auto pauseOf = [](int status, const std::string& retryAfter) {
        FileVersion version;
        RangeAnswer answer{status, "", "", "", 0, retryAfter};
        return judgeRangeAnswer({0, 50}, answer, version, where).error().retryAfterSeconds;
    };
    CHECK(pauseOf(429, "7") == 7);
    CHECK(pauseOf(503, "120") == 120);
    CHECK(pauseOf(503, "99999999999") == 3600);
    for (const char* no : {"", "-1", "1.5", "7 s", "99999999999999999999", "Wed, 21 Oct 2026 07:28:00 GMT"})
        CHECK(pauseOf(503, no) == 0);
}
