#include "server/http/content_coding.hpp"

#include <catch2/catch.hpp>

using namespace stipple::server;

namespace {

int quality(const char* field, std::string_view coding) {
    return codingQuality(field == nullptr ? std::nullopt : std::optional<std::string>(field), coding);
}

} // namespace

TEST_CASE("the quality of a coding is what its element says, 1 by default") {
    CHECK(quality("gzip", "gzip") == 1000);
    CHECK(quality("gzip;q=0.5, br;q=0.75", "gzip") == 500);
    CHECK(quality("gzip;q=0.5, br;q=0.75", "br") == 750);
    CHECK(quality("gzip ; q=0.001", "gzip") == 1);
    CHECK(quality("gzip;Q=1.000", "gzip") == 1000);
    CHECK(quality("gzip;q=1.", "gzip") == 1000);
    CHECK(quality("GZIP, BR", "br") == 1000);
    CHECK(quality("x-gzip", "gzip") == 1000);
    CHECK(quality("gzip;q=0", "gzip") == 0);
    CHECK(quality("gzip", "br") == 0);
    CHECK(quality("gzipped", "gzip") == 0);
}

TEST_CASE("a star speaks for what is not named") {
    CHECK(quality("*", "br") == 1000);
    CHECK(quality("gzip, *;q=0.2", "br") == 200);
    CHECK(quality("gzip;q=0, *", "gzip") == 0);
    CHECK(quality("*;q=0, gzip", "gzip") == 1000);
    CHECK(quality("*;q=0", "identity") == 0);
    CHECK(quality("*;q=0, identity", "identity") == 1000);
    CHECK(quality("*;q=0.5", "identity") == 500);
}

TEST_CASE("identity is the last resort unless it is refused") {
    CHECK(quality("gzip", "identity") == 1);
    CHECK(quality("", "identity") == 1);
    CHECK(quality("", "gzip") == 0);
    CHECK(quality("identity;q=0", "identity") == 0);
    CHECK(quality("gzip, identity;q=0.5", "identity") == 500);
    CHECK(quality(nullptr, "identity") == 1000);
    CHECK(quality(nullptr, "br") == 0);
}

TEST_CASE("codings that can't be read are passed over") {
    CHECK(quality(",, ,gzip,,", "gzip") == 1000);
    for (const char* element :
         {"gzip;q=", "gzip;q=2", "gzip;q=1.001", "gzip;q=0.0001", "gzip;q=-1", "gzip;q=.5", "gzip;q=0,5",
          "gzip;q=0.5;q=1", "gzip;x=1", "gzip;", "gzip q=1", "gz ip", ";q=1", "gzip=1"}) {
        INFO(element);
        CHECK(quality(element, "gzip") == 0);
    }
    CHECK(quality("gzip;q=2, br", "br") == 1000);
}

TEST_CASE("of a coding that is named twice the first counts") {
    CHECK(quality("gzip;q=0.3, gzip", "gzip") == 300);
    CHECK(quality("x-gzip;q=0.3, gzip", "gzip") == 300);
}
