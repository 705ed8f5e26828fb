#include "converter/input/text_guess.hpp"
#include "tests/unit/converter/input/read_table.hpp"

#include <cmath>

using namespace stipple;
using namespace stipple::test;

namespace {
Read readText(const std::string& text, const std::string& columns = "", double scale = 0) {
    InputOptions options;
    options.columns = columns;
    options.scale = scale;
    return readTable(openTextInput, text, options);
}
} // namespace

TEST_CASE("text: coordinates are held exactly, whatever their decimals") {
    Read read = readText("289814.15 4320978.61 170.76\n289814.6401 4320978.8 1.7e2\n-0.00 +5 .5\n");
    CHECK(read.description.grid.scale.x == 0.0001);
    const Grid& grid = read.description.grid;
    Vec3i k{std::llround(grid.offset.x * 1e4), std::llround(grid.offset.y * 1e4),
            std::llround(grid.offset.z * 1e4)};
    CHECK(read.points.positions[0] + k == Vec3i{2898141500, 43209786100, 1707600});
    CHECK(read.points.positions[1] + k == Vec3i{2898146401, 43209788000, 1700000});
    CHECK(read.points.positions[2] + k == Vec3i{0, 50000, 5000});
    CHECK(read.report.maxRounding == 0);
}

TEST_CASE("text: zeros behind the last decimal are none; too many decimals are rounded, which is said") {
    CHECK(readText("1.500000 2.250000 3\n").description.grid.scale.x == 0.01);
    Read read = readText("0 0 0\n10000.0000001 0 0\n0 0.12345678901234567890123 0\n");
    CHECK(read.description.grid.scale.x == 1e-6); // 10 km are at most 2^36 steps
    CHECK(read.report.maxRounding > 0);
    CHECK(read.report.maxRounding <= 0.5e-6);
    Read fine = readText("0 0 0\n10000.0000001 0 0\n", "", 1e-7);
    CHECK(fine.points.positions[1].x - fine.points.positions[0].x == 100000000001);
    // The bounds hold where 31 decimals round up (readAll compares them).
    CHECK(readText("0.0000000000000899999999999999999 0 1\n").points.size() == 1);
    Read quarter = readText("0.3 0.25 1\n", "", 0.25);
    CHECK(quarter.world(0) == Vec3d{0.25, 0.25, 1});
    CHECK(std::abs(quarter.report.maxRounding - 0.05) < 1e-12);
}

TEST_CASE("text: separators and decimal signs are guessed and said") {
    struct Case {
        const char *text, *says;
    };
    for (Case c :
         {Case{"1.5 2 3 9\n", "blanks"}, Case{"1.5,2,3,9\n", "commas"}, Case{"1.5;2;3;9\n", "semicolons"},
          Case{"1.5\t2\t3\t9\n", "blanks"}, Case{"1.5|2|3|9\n", "bars"},
          Case{"  1.5 \t 2   3 9  \n", "blanks"}, Case{"1,5;2;3;9\n", "semicolons with decimal commas"},
          Case{"1,5\t2\t3\t9\n", "tabs with decimal"}, Case{"1,5 2 3 9\n", "blanks with decimal"},
          Case{"1.5, 2, 3, 9\n", "commas"}, Case{"1.5,2,3,9,\n", "commas"},
          Case{"\"1.5\",\"2\",\"3\",\"9\"\n", "commas"}}) {
        INFO(c.text);
        Read read = readText(c.text);
        CHECK(read.world(0) == Vec3d{1.5, 2, 3});
        CHECK(read.column<std::uint16_t>("Intensity")[0] == 9);
        CHECK(read.description.source.format.find(c.says) != std::string::npos);
    }
}

TEST_CASE("text: columns are named by a header, by the user, or by their number and values") {
    Read header = readText("X,Y,Z,Intensity,Classification,Amplitude,Echo\n1,2,3,7,2,0.5,-300\n");
    CHECK(header.column<std::uint16_t>("Intensity")[0] == 7);
    CHECK(header.column<std::uint8_t>("Classification")[0] == 2);
    CHECK(header.column<double>("Amplitude")[0] == 0.5);
    CHECK(header.column<std::int16_t>("Echo")[0] == -300);
    Read comment = readText("//X Y Z R G B\n1\n1 2 3 4 5 6\n");
    CHECK(comment.column<std::uint16_t>("Green")[0] == 5);
    Read order = readText("id;northing;easting;height [m]\n5;1;2;3\n");
    CHECK(order.world(0) == Vec3d{2, 1, 3});
    CHECK(order.column<std::uint8_t>("id")[0] == 5);
    Read named = readText("whatever this is\n1 2 3 4 tree\n", "z,y,x,-,-");
    CHECK(named.world(0) == Vec3d{3, 2, 1});
    CHECK(named.schema().attributes.empty());
    Read label = readText("1 2 3 tree 4\n5 6 7 big_house 8\n");
    CHECK(label.column<std::uint8_t>("column 5") == std::vector<std::uint8_t>{4, 8});
    CHECK(label.warns("column 4 holds text"));
    Read colours = readText("1 2 3 255 0 9\n");
    CHECK(colours.column<std::uint16_t>("Red")[0] == 255);
    CHECK(colours.warns("taken as x y z red green blue, separated by blanks"));
    Read normals = readText("1 2 3 -0.5 0.5 0.7\n");
    CHECK(normals.column<double>("nx")[0] == -0.5);
    Read late = readText("1 2 3 4 5 6 0.25\n");
    CHECK(late.column<std::uint16_t>("Red")[0] == 4);
    Read unknown = readText("1 2 3 4 5\n");
    CHECK(unknown.column<std::uint8_t>("column 4")[0] == 4);
}

TEST_CASE("text: integers get the smallest type that holds them all") {
    Read read = readText("x y z a b c d e f g\n0 0 0 255 -1 256 -129 65536 9223372036854775807 1\n"
                         "0 0 0 0 127 0 0 0 0 1.5\n");
    CHECK(read.type("a") == AttributeType::u8);
    CHECK(read.type("c") == AttributeType::u16);
    CHECK(read.type("d") == AttributeType::i16);
    CHECK(read.type("e") == AttributeType::u32);
    CHECK(read.type("f") == AttributeType::u64);
    CHECK(read.column<std::uint64_t>("f")[0] == 9223372036854775807u);
}

TEST_CASE("text: comments, empty lines, byte order marks and every line end are read") {
    for (const char* ending : {"\n", "\r\n", "\r"}) {
        std::string text = "\xEF\xBB\xBF# made by hand";
        text += ending;
        text += ending;
        text +=
            std::string("1 2 3") + ending + "// half" + ending + "  " + ending + "4 5 6" + ending + "7 8 9";
        Read read = readText(text);
        CHECK(read.points.size() == 3);
        CHECK(read.world(2) == Vec3d{7, 8, 9});
    }
}

TEST_CASE("text: values that are missing or no number are kept as NaN, places without one are left out") {
    Read read = readText("x,y,z,q\n1,2,3,4\n1,2,3,\n1,nan,3,5\n,1,2,6\n1e15,0,0,7\n");
    REQUIRE(read.points.size() == 2);
    CHECK(std::isnan(read.column<double>("q")[1]));
    CHECK(read.report.notFinite == 2);
    CHECK(read.report.outOfRange == 1);
}

TEST_CASE("PTS: counted points, several times, with signed intensities") {
    Read read = readText("2\n1 2 3 -2048 1 2 3\n4 5 6 2047 4 5 6\n\n1\n7 8 9 0 7 8 9\n");
    CHECK(read.column<std::uint16_t>("Intensity") == std::vector<std::uint16_t>{0, 4095, 2048});
    CHECK(read.column<std::uint16_t>("Blue") == std::vector<std::uint16_t>{3, 6, 9});
    CHECK(read.description.source.format.find("PTS") == 0);
    CHECK(refusal(openTextInput, "3\n1 2 3\n1 2 3\n").find("promises 3 points, but holds 2") !=
          std::string::npos);
    CHECK(readText("1\n1 2 3\n4 5 6\n").warns("more points than"));
}

TEST_CASE("text: many lines are divided into parts, the same read from any of them") {
    std::string text = "x y z t\r\n# a comment\r\n";
    constexpr int count = 600'000;
    for (int i = 0; i < count; ++i)
        text +=
            std::to_string(i) + ".5 0 1 " + std::to_string(i % 251) + (i % 1000 == 0 ? "\r\n\r\n" : "\r\n");
    Read read = readText(text);
    CHECK(read.parts == 3);
    bool equal = read.points.size() == count;
    std::vector<std::uint8_t> t = read.column<std::uint8_t>("t");
    for (std::size_t i = 0; equal && i < count; ++i)
        equal = read.points.positions[i].x == static_cast<std::int64_t>(i) * 10 + 5 && t[i] == i % 251;
    CHECK(equal);
}

TEST_CASE("text: refusals name line and column") {
    auto says = [](const std::string& file, const std::string& words, const std::string& columns = "") {
        InputOptions options;
        options.columns = columns;
        std::string sentence = refusal(openTextInput, file, options);
        INFO(sentence);
        CHECK(sentence.find(words) != std::string::npos);
    };
    says("1 2 3\n\n4 5\n", "scan, line 3: there are 2 columns of 3");
    says("1 2 3\n4 5 6 7\n", "scan, line 2: there are more than 3 columns");
    says("1 2 3\n4 5x 6\n", "scan, line 2: column 2: \"5x\" is no number");
    says("1;2;3\n4;5;6,5\n", "scan, line 2: column 3: \"6,5\" is no number");
    says("1,2,3\n4,5\n", "line 2: there are 2 columns of 3");
    says("x y z i\n1 2 3\n", "the header names 4 columns, but the first line of data has 3");
    says("1 2 3\n", "--columns names 2 columns", "x,y");
    says("1 2 3\n", "no column of numbers is named z", "x,y,w");
    says("a poem\nof two lines\n", "no line has three numbers");
    says("1 2\n3 4\n", "no line has three numbers");
    says("1 2 3\n" + std::string(3 << 20, '7'), "line 2: the line is longer than");
    says(std::string("1 2 3\n4 \0 6\n", 12), "no line has three numbers");
}

TEST_CASE("text: damaged anywhere, it is refused or read") {
    std::string csv = "X,Y,Z,Intensity\n1.5,2,3,4\n-1,2e1,3,40000\n";
    damageEverywhere(openTextInput, bytesOf(csv), csv.size());
    std::string pts = "2\n1 2 3 -5 1 2 3\n4 5 6 2 4 5 6\n";
    damageEverywhere(openTextInput, bytesOf(pts), pts.size());
}

TEST_CASE("text is told from other files by its first lines") {
    CHECK(looksLikeText("1 2 3\n"));
    CHECK(looksLikeText("x,y,z\n1,2,3\n"));
    CHECK_FALSE(looksLikeText("<html>1 2 3</html>\n"));
    CHECK_FALSE(looksLikeText(std::string_view("1 2 3\n\0\0", 8)));
    CHECK_FALSE(looksLikeText("Dear Sir,\nplease find 3 points\n"));
    CHECK_FALSE(looksLikeText(""));
    CHECK(looksLikePtx("2\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 2 3 0.5\n"));
    CHECK_FALSE(looksLikePtx("2\n1 2 3\n4 5 6\n"));
}

TEST_CASE("PTS: files of other programs are read") {
    STIPPLE_NEEDS_DATA();
    Read autzen = readFile("autzen.pts");
    CHECK(autzen.points.size() == 10);
    CHECK(autzen.description.grid.scale.x == 1e-6);
    CHECK(autzen.column<std::uint16_t>("Intensity")[0] == 2048 - 1613);
    CHECK(std::abs(autzen.world(0).x - 636110.300003) < 1e-9);
    CHECK(readFile("test.pts").points.size() == 19);
}
