// Results, errors, text and little-endian bytes.
#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"
#include "shared/base/text.hpp"

#include <catch2/catch.hpp>

#include <memory>
#include <set>

using namespace stipple;

namespace {

Result<int> half(int number) {
    if (number % 2 != 0)
        return Error{ErrorCode::invalidArgument, "is odd", "", ""};
    return number / 2;
}

Result<int> quarter(int number) {
    STIPPLE_TRY(halved, half(number));
    return half(halved);
}

Status requireQuarter(int number) {
    STIPPLE_CHECK(quarter(number));
    return {};
}

} // namespace

TEST_CASE("a result is a value or an error, and macros pass the error on") {
    CHECK(quarter(12).ok());
    CHECK(*quarter(12) == 3);
    CHECK(!quarter(6).ok());
    CHECK(quarter(6).error().what == "is odd");
    CHECK(quarter(7).error().code == ErrorCode::invalidArgument);
    CHECK(requireQuarter(8).ok());
    CHECK(requireQuarter(6).error().what == "is odd");
}

TEST_CASE("a result hands its value over, also one that can't be copied") {
    Result<std::unique_ptr<int>> made = std::make_unique<int>(5);
    std::unique_ptr<int> taken = *std::move(made);
    CHECK(*taken == 5);
}

TEST_CASE("an error is one sentence: where, what, and what to do") {
    Error error{ErrorCode::truncated, "the header ends after 12 of 128 bytes", "", ""};
    CHECK(error.sentence() == "the header ends after 12 of 128 bytes");
    error.where = "byte 12";
    error.advice = "copy it again";
    CHECK(error.at("a.las").sentence() ==
          "a.las, byte 12: the header ends after 12 of 128 bytes (copy it again)");
    error.where = "";
    CHECK(error.at("a.las").where == "a.las");
}

TEST_CASE("every error code has a name of its own") {
    std::set<std::string> names;
    int codes = static_cast<int>(ErrorCode::cancelled) + 1;
    for (int code = 0; code < codes; ++code)
        names.insert(errorCodeName(static_cast<ErrorCode>(code)));
    CHECK(names.size() == static_cast<std::size_t>(codes));
    CHECK(names.count("unknown") == 0);
}

TEST_CASE("text is put together from strings, characters and numbers") {
    std::uint8_t small = 7;
    CHECK(cat("a", std::string("b"), 'c', 1, -2, small, true, " ", 0.5, " ", 0.1f) ==
          "abc1-27true 0.5 0.1000000015");
    CHECK(cat() == "");
    CHECK(cat(18446744073709551615ull, " ", -9223372036854775807ll) ==
          "18446744073709551615 -9223372036854775807");
}

TEST_CASE("numbers are written and read back in little-endian order") {
    ByteWriter writer;
    writer.write(std::uint32_t{0x01020304});
    writer.write(std::int16_t{-2});
    writer.write(1.5);
    writer.writeFixedText("abc", 5);
    writer.writeFixedText("abcdef", 3);
    CHECK(writer.size() == 4 + 2 + 8 + 5 + 3);
    Bytes bytes = writer.take();
    CHECK(Bytes(bytes.begin(), bytes.begin() + 6) == Bytes{4, 3, 2, 1, 0xFE, 0xFF});
    ByteReader reader(bytes);
    CHECK(reader.read<std::uint32_t>() == 0x01020304);
    CHECK(reader.read<std::int16_t>() == -2);
    CHECK(reader.read<double>() == 1.5);
    CHECK(reader.readFixedText(5) == "abc");
    CHECK(reader.readFixedText(3) == "abc");
    CHECK(reader.ok());
    CHECK(reader.remaining() == 0);
}

TEST_CASE("a reader that runs out gives zeros and stays failed") {
    Bytes bytes{1, 2, 3};
    ByteReader reader(bytes);
    CHECK(reader.read<std::uint16_t>() == 0x0201);
    CHECK(reader.read<std::uint32_t>() == 0);
    CHECK(!reader.ok());
    CHECK(reader.read<std::uint8_t>() == 0); // though one byte was left
    CHECK(reader.readBytes(1).empty());
    CHECK(reader.remaining() == 0);
    ByteReader other(bytes);
    other.skip(~std::size_t{0});
    CHECK(!other.ok());
}

TEST_CASE("the bits of a number can be seen as another type") {
    CHECK(bitCast<std::uint64_t>(1.0) == 0x3FF0000000000000);
    CHECK(bitCast<float>(0x40490FDBu) == Approx(3.14159274));
}
