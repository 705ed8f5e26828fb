#include "tests/unit/converter/input/read_table.hpp"

#include <cmath>
#include <random>

using namespace stipple;
using namespace stipple::test;

namespace {
std::string header(const std::string& fields, const std::string& sizes, const std::string& types,
                   const std::string& counts, std::size_t points, const std::string& data) {
    std::string n = std::to_string(points);
    return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes +
           "\nTYPE " + types + "\nCOUNT " + counts + "\nWIDTH " + n +
           "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA " + data + "\n";
}

template <class T>
void put(Bytes& bytes, T value) {
    std::size_t at = bytes.size();
    bytes.resize(at + sizeof(T));
    storeLe(bytes.data() + at, value);
}

// A plain LZF encoder: literals, and references to the last place where the next three bytes stood.
Bytes lzf(const Bytes& in) {
    Bytes out, literals;
    auto flush = [&] {
        for (std::size_t i = 0; i < literals.size(); i += 32) {
            std::size_t count = std::min<std::size_t>(32, literals.size() - i);
            out.push_back(static_cast<std::uint8_t>(count - 1));
            out.insert(out.end(), literals.begin() + static_cast<std::ptrdiff_t>(i),
                       literals.begin() + static_cast<std::ptrdiff_t>(i + count));
        }
        literals.clear();
    };
    std::vector<std::size_t> last(1 << 16, ~std::size_t{0});
    for (std::size_t i = 0; i < in.size();) {
        std::size_t length = 0, from = 0;
        if (i + 3 <= in.size()) {
            std::size_t hash = (in[i] * 7919u + in[i + 1] * 271u + in[i + 2]) & 0xFFFF;
            from = last[hash];
            last[hash] = i;
            if (from != ~std::size_t{0} && i - from <= 8192)
                while (length < 264 && i + length < in.size() && in[from + length] == in[i + length])
                    ++length;
        }
        if (length < 3) {
            literals.push_back(in[i++]);
            continue;
        }
        flush();
        std::size_t back = i - from - 1;
        if (length < 9) {
            out.push_back(static_cast<std::uint8_t>((length - 2) << 5 | back >> 8));
        } else {
            out.push_back(static_cast<std::uint8_t>(7 << 5 | back >> 8));
            out.push_back(static_cast<std::uint8_t>(length - 9));
        }
        out.push_back(static_cast<std::uint8_t>(back & 0xFF));
        i += length;
    }
    flush();
    return out;
}

Bytes compressed(const std::string& header, const Bytes& columns) {
    Bytes file = bytesOf(header), body = lzf(columns);
    put(file, static_cast<std::uint32_t>(body.size()));
    put(file, static_cast<std::uint32_t>(columns.size()));
    file.insert(file.end(), body.begin(), body.end());
    return file;
}
} // namespace

TEST_CASE("PCD: fields of every type, of several values, and padding are read from binary") {
    Bytes file = bytesOf(
        header("x y z _ n big small", "8 4 4 1 2 8 1", "F F F U U I I", "1 1 1 3 2 1 1", 2, "binary"));
    for (int i = 0; i < 2; ++i) {
        put(file, 1.5 + i);
        put(file, -2.f);
        put(file, 3.f);
        put(file, std::uint8_t{9});
        put(file, std::uint8_t{9});
        put(file, std::uint8_t{9});
        put(file, static_cast<std::uint16_t>(10 + i));
        put(file, static_cast<std::uint16_t>(20 + i));
        put(file, INT64_MIN + i);
        put(file, static_cast<std::int8_t>(-3));
    }
    Read read = readTable(openPcdInput, file);
    CHECK(read.description.source.format == "PCD, binary");
    CHECK(read.world(1) == Vec3d{2.5, -2, 3});
    CHECK(read.column<std::uint16_t>("n") == std::vector<std::uint16_t>{10, 20, 11, 21});
    CHECK(read.column<std::int64_t>("big") == std::vector<std::int64_t>{INT64_MIN, INT64_MIN + 1});
    CHECK(read.column<std::int8_t>("small") == std::vector<std::int8_t>{-3, -3});
    CHECK(read.schema().find("_") < 0);
}

TEST_CASE("PCD: packed colours become Red, Green and Blue") {
    for (const char* type : {"F", "U"}) {
        Bytes file =
            bytesOf(header("x y z rgb", "4 4 4 4", std::string("F F F ") + type, "1 1 1 1", 1, "binary"));
        for (float value : {1.f, 2.f, 3.f})
            put(file, value);
        put(file, std::uint32_t{0xFF0A141E});
        Read read = readTable(openPcdInput, file);
        CHECK(read.column<std::uint16_t>("Red")[0] == 10);
        CHECK(read.column<std::uint16_t>("Green")[0] == 20);
        CHECK(read.column<std::uint16_t>("Blue")[0] == 30);
        CHECK(read.schema().find("alpha") < 0);
    }
    // In ASCII a float is written as its value: 0x004080C0 as a denormal number, or as an integer where TYPE
    // is U.
    Read text = readTable(openPcdInput, header("x y z rgba", "4 4 4 4", "F F F U", "1 1 1 1", 1, "ascii") +
                                            "1 2 3 4286611584\n");
    CHECK(text.column<std::uint16_t>("Red")[0] == 0x80);
    CHECK(text.column<std::uint8_t>("alpha")[0] == 0xFF);
    Read denormal = readTable(openPcdInput, header("x y z rgb", "4 4 4 4", "F F F F", "1 1 1 1", 1, "ascii") +
                                                "1 2 3 5.923e-39\n");
    CHECK(denormal.column<std::uint16_t>("Red")[0] == 0x40);
}

TEST_CASE("PCD: ASCII points without a place are left out and counted") {
    Read read = readTable(openPcdInput, header("x y z k", "4 4 4 1", "F F F U", "1 1 1 1", 3, "ascii") +
                                            "1.25 2 3 1\nnan nan nan 2\n-1 -inf 0 3\n");
    CHECK(read.points.positions == std::vector<Vec3i>{{125, 200, 300}});
    CHECK(read.report.notFinite == 2);
}

TEST_CASE("PCD: version 0.5 without COUNT and POINTS is read; a pose is said to be ignored") {
    Read read =
        readTable(openPcdInput, "# .PCD v.5\nVERSION .5\nCOLUMNS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\n"
                                "HEIGHT 2\nVIEWPOINT 1 2 3 0 1 0 0\nDATA ascii\n1 2 3\n4 5 6\n");
    CHECK(read.points.size() == 2);
    CHECK(read.warns("VIEWPOINT 1 2 3 0 1 0 0"));
}

TEST_CASE("PCD: compressed columns are decoded from any part on") {
    constexpr std::size_t count = 600'000;
    std::mt19937 random(3);
    Bytes columns;
    std::vector<float> xs(count), ys(count);
    std::vector<std::uint8_t> tags(count);
    for (std::size_t i = 0; i < count; ++i) {
        xs[i] = static_cast<float>(i % 1000) * 0.25f;
        ys[i] = static_cast<float>(random() % 100000) * 0.5f;
        tags[i] = static_cast<std::uint8_t>(i / 7);
    }
    for (float v : xs)
        put(columns, v);
    columns.insert(columns.end(), tags.begin(), tags.end());
    for (float v : ys)
        put(columns, v);
    for (std::size_t i = 0; i < count; ++i)
        put(columns, 1.f);
    Read read = readTable(openPcdInput, compressed(header("x tag y z _", "4 1 4 4 1", "F U F F U",
                                                          "1 1 1 1 4", count, "binary_compressed"),
                                                   columns));
    CHECK(read.parts == 3);
    CHECK(read.column<std::uint8_t>("tag") == tags);
    bool equal = true;
    for (std::size_t i = 0; i < count; ++i) {
        Vec3d p = read.world(i);
        equal = equal && static_cast<float>(p.x) == xs[i] && static_cast<float>(p.y) == ys[i] && p.z == 1;
    }
    CHECK(equal);
}

TEST_CASE("PCD: refusals name the line or the byte") {
    auto says = [](const std::string& file, const std::string& words) {
        std::string sentence = refusal(openPcdInput, file);
        INFO(sentence);
        CHECK(sentence.find(words) != std::string::npos);
    };
    const std::string good = header("x y z", "4 4 4", "F F F", "1 1 1", 1, "ascii");
    says("VERSION 0.7\nFIELDS x\n", "scan, line 2: the header has no DATA line");
    says("VERSION 0.7\nFILEDS x\n", "line 2: \"FILEDS\" is no line of a header");
    says(header("x y z", "4 4", "F F F", "1 1 1", 1, "ascii"),
         "FIELDS names 3 fields, but SIZE, TYPE and COUNT");
    says(header("x y z", "4 4 3", "F F F", "1 1 1", 1, "ascii"), "the field z has TYPE F and SIZE 3");
    says(header("x y z", "4 4 4", "F F F", "1 1 0", 1, "ascii"), "COUNT 0");
    says(header("x y w", "4 4 4", "F F F", "1 1 1", 1, "ascii"), "no field \"z\"");
    says(header("x y z", "4 4 4", "F F F", "1 1 1", 1, "zipped"), "there is no DATA zipped");
    says(good, "after 0 of 1 points");
    says(header("x y z", "4 4 4", "F F F", "1 1 1", 9, "binary") + "123", "promises 9 points of 12 bytes");
    std::string product = good;
    product.replace(product.find("WIDTH 1"), 7, "WIDTH 3");
    says(product + "1 2 3\n", "POINTS is 1, but WIDTH x HEIGHT is 3");
    const std::string packed = header("x y z", "4 4 4", "F F F", "1 1 1", 2, "binary_compressed");
    says(packed + "1234", "sizes of the compressed points are missing");
    says(packed + std::string("\x05\0\0\0\x18\0\0\0\0A", 10), "promises 5 compressed bytes");
    says(packed + std::string("\x02\0\0\0\x19\0\0\0\0A", 10), "not the 25 bytes");
    says(packed + std::string("\x02\0\0\0\x18\0\0\0\0A", 10), "the compressed points end early");
    says(packed + std::string("\x03\0\0\0\x18\0\0\0\x20\x05\x05", 11), "bytes before the first");
}

TEST_CASE("PCD: damaged anywhere, it is refused or read") {
    Bytes columns;
    for (int i = 0; i < 40; ++i)
        put(columns, static_cast<float>(i % 5));
    const std::string fields = "x y z rgb";
    Bytes packed =
        compressed(header(fields, "4 4 4 4", "F F F F", "1 1 1 1", 10, "binary_compressed"), columns);
    CHECK(damageEverywhere(openPcdInput, packed, packed.size()) > packed.size() - 1);
    Bytes binary = bytesOf(header(fields, "4 4 4 4", "F F F F", "1 1 1 1", 10, "binary"));
    const std::size_t headerBytes = binary.size();
    binary.insert(binary.end(), columns.begin(), columns.end());
    CHECK(damageEverywhere(openPcdInput, binary, headerBytes) > headerBytes);
    std::string text = header("x y z k", "4 4 4 1", "F F F U", "1 1 1 1", 2, "ascii") + "1 2 3 4\n1 2 3 4\n";
    CHECK(damageEverywhere(openPcdInput, bytesOf(text), text.size()) > text.size() / 2);
}

TEST_CASE("PCD: files of other programs are read or refused") {
    STIPPLE_NEEDS_DATA();
    Read room = readFile("room_scan1.pcd");
    CHECK(room.points.size() + room.report.dropped() == 112586);
    Read mug = readFile("table_scene_mug_stereo_textured.pcd");
    CHECK(mug.points.size() + mug.report.notFinite == 307200);
    CHECK(mug.schema().find("Red") >= 0);
    CHECK(mug.warns("VIEWPOINT"));
    CHECK(readFile("simple-ascii.pcd").points.size() == 213);
    Read autzen = readFile("autzen-utm.pcd");
    CHECK(autzen.points.size() == 1065);
    CHECK(autzen.type("Intensity") == AttributeType::u16);
    CHECK(autzen.type("GPS Time") == AttributeType::f64);
    CHECK(autzen.type("Scan Angle Rank") == AttributeType::i8);
    CHECK(readFile("missingheader.pcd").points.size() == 10); // as the text that it is
}
