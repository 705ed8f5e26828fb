#include "tests/unit/converter/input/read_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

using namespace stipple;
using namespace stipple::test;

namespace {
// Writes PLY, one value after the other.
class PlyWriter {
  public:
    PlyWriter(const std::string& header, bool bigEndian) : bytes_(bytesOf(header)), bigEndian_(bigEndian) {}

    template <class T>
    PlyWriter& put(T value) {
        std::uint8_t raw[sizeof(T)];
        std::memcpy(raw, &value, sizeof(T));
        if (bigEndian_)
            std::reverse(raw, raw + sizeof(T));
        bytes_.insert(bytes_.end(), raw, raw + sizeof(T));
        return *this;
    }
    const Bytes& bytes() const { return bytes_; }

  private:
    Bytes bytes_;
    bool bigEndian_;
};

std::string header(const std::string& format, const std::string& elements) {
    return "ply\nformat " + format + " 1.0\ncomment made by hand\n" + elements + "end_header\n";
}

} // namespace

TEST_CASE("PLY: every type and both byte orders are read") {
    for (bool big : {false, true}) {
        PlyWriter file(header(big ? "binary_big_endian" : "binary_little_endian",
                              "element vertex 2\nproperty char a\nproperty uint8 k\nproperty short c\n"
                              "property ushort d\nproperty int e\nproperty uint f\nproperty float g\n"
                              "property double h\nproperty float32 x\nproperty double y\nproperty int16 z\n"),
                       big);
        for (int i = 0; i < 2; ++i)
            file.put<std::int8_t>(i ? 127 : -128)
                .put<std::uint8_t>(i ? 255 : 0)
                .put<std::int16_t>(i ? 32767 : -32768)
                .put<std::uint16_t>(i ? 65535 : 1)
                .put<std::int32_t>(i ? INT32_MAX : INT32_MIN)
                .put<std::uint32_t>(i ? UINT32_MAX : 2)
                .put<float>(i ? 1.5f : NAN)
                .put<double>(i ? -0.1 : 1e300)
                .put<float>(i ? 0.25f : -7.5f)
                .put<double>(i ? 1e6 : 0.125)
                .put<std::int16_t>(i ? 5 : -5);
        Read read = readTable(openPlyInput, file.bytes());
        REQUIRE(read.points.size() == 2);
        CHECK(read.description.source.format ==
              (big ? "PLY, binary big endian" : "PLY, binary little endian"));
        CHECK(read.column<std::int8_t>("a") == std::vector<std::int8_t>{-128, 127});
        CHECK(read.column<std::uint8_t>("k") == std::vector<std::uint8_t>{0, 255});
        CHECK(read.column<std::int16_t>("c") == std::vector<std::int16_t>{-32768, 32767});
        CHECK(read.column<std::uint16_t>("d") == std::vector<std::uint16_t>{1, 65535});
        CHECK(read.column<std::int32_t>("e") == std::vector<std::int32_t>{INT32_MIN, INT32_MAX});
        CHECK(read.column<std::uint32_t>("f") == std::vector<std::uint32_t>{2, UINT32_MAX});
        CHECK(std::isnan(read.column<float>("g")[0]));
        CHECK(read.column<double>("h") == std::vector<double>{1e300, -0.1});
        CHECK(read.world(0) == Vec3d{-7.5, 0.125, -5});
        CHECK(read.world(1) == Vec3d{0.25, 1e6, 5});
    }
}

TEST_CASE("PLY: ASCII coordinates are exact decimals") {
    Read read =
        readTable(openPlyInput, header("ascii", "element vertex 3\nproperty float x\nproperty float y\n"
                                                "property float z\nproperty float quality\n") +
                                    "636110.30 849345.05 -0.001 0.1\n1e-3 2.5E2 3 nan\n -1 0 0 7\n");
    CHECK(read.description.grid.scale == Vec3d{0.001, 0.001, 0.001});
    CHECK(read.points.positions ==
          std::vector<Vec3i>{{636110300, 849345050, -1}, {1, 250000, 3000}, {-1000, 0, 0}});
    CHECK(read.report.maxRounding == 0);
    CHECK(read.type("quality") == AttributeType::f32);
    CHECK(read.column<float>("quality")[0] == 0.1f);
    CHECK(std::isnan(read.column<float>("quality")[1]));
}

TEST_CASE("PLY: 8-bit colours keep their values, colours from 0 to 1 become 16-bit") {
    const std::string position = "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n";
    Read bytes = readTable(
        openPlyInput, header("ascii", position + "property uchar diffuse_red\nproperty uchar diffuse_green\n"
                                                 "property uchar diffuse_blue\nproperty uchar alpha\n") +
                          "0 0 0 255 0 7 255\n1 1 1 1 2 3 4\n");
    CHECK(bytes.column<std::uint16_t>("Red") == std::vector<std::uint16_t>{255, 1});
    CHECK(bytes.column<std::uint16_t>("Blue") == std::vector<std::uint16_t>{7, 3});
    CHECK(bytes.column<std::uint8_t>("alpha") == std::vector<std::uint8_t>{255, 4});
    Read floats = readTable(openPlyInput, header("ascii", position + "property float r\nproperty float g\n"
                                                                     "property float b\n") +
                                              "0 0 0 0 0.5 1\n1 1 1 1 1 0.2\n");
    CHECK(floats.column<std::uint16_t>("Red") == std::vector<std::uint16_t>{0, 65535});
    CHECK(floats.column<std::uint16_t>("Green") == std::vector<std::uint16_t>{32768, 65535});
    CHECK(floats.warns("round(65535 x number)"));
    Read whole = readTable(openPlyInput, header("ascii", position + "property float r\nproperty float g\n"
                                                                    "property float b\n") +
                                             "0 0 0 0 128 255\n1 1 1 1 1 0\n");
    CHECK(whole.column<std::uint16_t>("Blue") == std::vector<std::uint16_t>{255, 0});
    Read odd = readTable(openPlyInput, header("ascii", position + "property float r\nproperty float g\n"
                                                                  "property float b\n") +
                                           "0 0 0 0 -1 2.5\n1 1 1 1 1 0\n");
    CHECK(odd.type("r") == AttributeType::f32);
    CHECK(odd.warns("not shown"));
}

TEST_CASE("PLY: names of LAS are found where the values fit") {
    const std::string position = "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n";
    Read read = readTable(openPlyInput, header("ascii", position + "property float scalar_Intensity\n"
                                                                   "property uchar classification\n"
                                                                   "property float scalar_Return_Number\n"
                                                                   "property double GpsTime\n"
                                                                   "property int number_of_returns\n") +
                                            "0 0 0 1200 2 1 1.25 3\n1 1 1 65535 3 2 2.5 40\n");
    CHECK(read.column<std::uint16_t>("Intensity") == std::vector<std::uint16_t>{1200, 65535});
    CHECK(read.column<std::uint8_t>("Classification") == std::vector<std::uint8_t>{2, 3});
    CHECK(read.column<std::uint8_t>("Return Number") == std::vector<std::uint8_t>{1, 2});
    CHECK(read.column<double>("GPS Time") == std::vector<double>{1.25, 2.5});
    CHECK(read.column<std::int32_t>("number_of_returns") == std::vector<std::int32_t>{3, 40});
    CHECK(read.warns("not all values of number_of_returns"));
}

TEST_CASE("PLY: lists and other elements are passed over, wherever they stand") {
    const std::string elements = "element camera 1\nproperty list uchar float pose\nproperty int id\n"
                                 "element vertex 2\nproperty float x\nproperty list uint8 int32 seen\n"
                                 "property float y\nproperty float z\nproperty uchar tag\n"
                                 "element face 1\nproperty list uchar int vertex_indices\n";
    for (bool big : {false, true}) {
        PlyWriter file(header(big ? "binary_big_endian" : "binary_little_endian", elements), big);
        file.put<std::uint8_t>(2).put(1.f).put(2.f).put<std::int32_t>(9);
        file.put(1.f).put<std::uint8_t>(0).put(2.f).put(3.f).put<std::uint8_t>(4);
        file.put(-1.f).put<std::uint8_t>(3).put(1).put(2).put(3).put(-2.f).put(-3.f).put<std::uint8_t>(5);
        file.put<std::uint8_t>(3).put(0).put(1).put(0);
        Read read = readTable(openPlyInput, file.bytes());
        CHECK(read.world(0) == Vec3d{1, 2, 3});
        CHECK(read.world(1) == Vec3d{-1, -2, -3});
        CHECK(read.column<std::uint8_t>("tag") == std::vector<std::uint8_t>{4, 5});
        CHECK(read.warns("1 of \"face\" are not"));
        CHECK(read.warns("the list \"seen\""));
    }
    Read text = readTable(openPlyInput,
                          header("ascii", elements) + "2 1 2 9\n1 0 2 3 4\n-1 3 1 2 3 -2 -3 5\n3 0 1 0\n");
    CHECK(text.world(1) == Vec3d{-1, -2, -3});
}

TEST_CASE("PLY: line ends of every system are read") {
    const std::string lf = header("ascii", "element vertex 2\nproperty float x\nproperty float y\n"
                                           "property float z\n") +
                           "1 2 3\n4 5 6";
    for (const char* ending : {"\n", "\r\n", "\r"}) {
        std::string text;
        for (char c : lf)
            text += c == '\n' ? std::string(ending) : std::string(1, c);
        CHECK(readTable(openPlyInput, text).world(1) == Vec3d{4, 5, 6});
    }
}

TEST_CASE("PLY: points that are no places are left out and counted") {
    PlyWriter file(header("binary_little_endian", "element vertex 4\nproperty float x\nproperty float y\n"
                                                  "property float z\nproperty uchar tag\n"),
                   false);
    file.put(1.f).put(NAN).put(0.f).put<std::uint8_t>(1);
    file.put(1.f).put(2.f).put(3.f).put<std::uint8_t>(2);
    file.put(1.f).put(2.f).put(INFINITY).put<std::uint8_t>(3);
    file.put(3e38f).put(2.f).put(3.f).put<std::uint8_t>(4);
    Read read = readTable(openPlyInput, file.bytes());
    CHECK(read.column<std::uint8_t>("tag") == std::vector<std::uint8_t>{2});
    CHECK(read.report.notFinite == 2);
    CHECK(read.report.outOfRange == 1);
}

TEST_CASE("PLY: many points are divided into parts, the same read from any of them") {
    for (const char* format : {"binary_little_endian", "ascii"}) {
        constexpr int count = 600'000;
        PlyWriter file(
            header(format, "element vertex 600000\nproperty int x\nproperty int y\nproperty int z\n"), false);
        Bytes bytes = file.bytes();
        for (int i = 0; i < count; ++i) {
            if (format[0] == 'a') {
                std::string line = std::to_string(i) + " " + std::to_string(-i) + " 7\n";
                bytes.insert(bytes.end(), line.begin(), line.end());
                continue;
            }
            for (std::int32_t value : {i, -i, 7}) {
                std::uint8_t raw[4];
                storeLe(raw, value);
                bytes.insert(bytes.end(), raw, raw + 4);
            }
        }
        Read read = readTable(openPlyInput, bytes);
        CHECK(read.parts == 3);
        bool equal = true;
        for (int i = 0; i < count; ++i)
            equal = equal && read.points.positions[static_cast<std::size_t>(i)] == Vec3i{i, -i, 7};
        CHECK(equal);
        CHECK(read.description.grid.scale.x == 1);
    }
}

TEST_CASE("PLY: refusals name the line or the byte") {
    const std::string good = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
    CHECK(refusal(openPlyInput, "ply\nformat ascii 1.0\n") ==
          "scan, line 2: the header has no \"end_header\" (was the file copied completely?)");
    CHECK(refusal(openPlyInput, header("ascii", "element vertex 1\nproperty quad x\n"))
              .find("line 5: there is no type \"quad\"") != std::string::npos);
    CHECK(refusal(openPlyInput, header("ascii", "element vertex -1\n")).find("no number of elements") !=
          std::string::npos);
    CHECK(refusal(openPlyInput, header("ascii", "element face 0\n")).find("no element \"vertex\"") !=
          std::string::npos);
    CHECK(refusal(openPlyInput, header("ascii", "element vertex 1\nproperty float x\nproperty float y\n"))
              .find("no property \"z\"") != std::string::npos);
    CHECK(refusal(openPlyInput, header("ascii", good) + "1 2\n").find("line 9: there are 2 columns of 3") !=
          std::string::npos);
    CHECK(refusal(openPlyInput, header("ascii", good) + "1 2 3 4\n").find("line 9: there are more than 3") !=
          std::string::npos);
    CHECK(refusal(openPlyInput, header("ascii", good) + "1 two 3\n")
              .find("line 9: column 2: \"two\" is no number") != std::string::npos);
    CHECK(refusal(openPlyInput, header("ascii", good)).find("after 0 of 1 points") != std::string::npos);
    CHECK(refusal(openPlyInput, header("ascii", good + "property uchar k\n") + "1 2 3 256\n")
              .find("column 4 (k): the value is no uint8") != std::string::npos);
    CHECK(refusal(openPlyInput, header("binary_little_endian", good) + "12345678901")
              .find("promises 1 vertices of 12 bytes, but the file has only 11") != std::string::npos);
    std::string lie = good;
    lie.replace(lie.find('1'), 1, "18446744073709551615");
    CHECK(refusal(openPlyInput, header("binary_little_endian", lie) + "123").find("promises") !=
          std::string::npos);
    CHECK(refusal(openPlyInput, header("ascii", lie) + "1 2 3\n").find("after 1 of") != std::string::npos);
}

TEST_CASE("PLY: damaged anywhere, it is refused or read") {
    const std::string elements = "element camera 1\nproperty list uchar float pose\n"
                                 "element vertex 2\nproperty float x\nproperty list uint8 int32 seen\n"
                                 "property float y\nproperty float z\nproperty uchar red\n";
    PlyWriter file(header("binary_little_endian", elements), false);
    file.put<std::uint8_t>(1).put(1.f);
    for (int i = 0; i < 2; ++i)
        file.put(1.f).put<std::uint8_t>(1).put(5).put(2.f).put(3.f).put<std::uint8_t>(4);
    CHECK(damageEverywhere(openPlyInput, file.bytes(), file.bytes().size()) > file.bytes().size() - 2);
    std::string text = header("ascii", elements) + "1 5\n1 1 5 2 3 4\n1 0 2 3 4\n";
    CHECK(damageEverywhere(openPlyInput, bytesOf(text), text.size()) > text.size() - 4);
}

TEST_CASE("PLY: files of other programs are read") {
    STIPPLE_NEEDS_DATA();
    Read bunny = readFile("bun_zipper.ply");
    CHECK(bunny.points.size() == 35947);
    CHECK(bunny.type("confidence") == AttributeType::f32);
    CHECK(bunny.type("Intensity") == AttributeType::u16);
    CHECK(bunny.column<std::uint16_t>("Intensity")[0] == 32768);
    CHECK(bunny.report.maxRounding <= 0.5e-10); // some have 12 decimals
    Vec3d first = bunny.world(0);
    CHECK(std::abs(first.x + 0.0378297) < 1e-12);
    CHECK(readFile("mesh.ply").points.size() == 4);
    CHECK(readFile("simple_binary.ply").points.size() == 3);
    CHECK(readFile("simple_text.ply").world(0) == Vec3d{-1, 0, 0});
    Read extra = readFile("text_extradim.ply");
    CHECK(extra.column<std::uint16_t>("Blue") == std::vector<std::uint16_t>{64});
    CHECK(extra.column<std::int32_t>("omg") == std::vector<std::int32_t>{1234});
    CHECK(extra.column<float>("nx") == std::vector<float>{-0.0237552f});
}
