// Tables of text that several threads read at once when they are opened: the same as with one.
#include "tests/unit/converter/input/read_table.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {

constexpr int manyRows = 450'000; // more than 8 MiB of text: three stretches

// Row `i` of the test files, whose points are told by their number.
std::string row(int i) {
    return std::to_string(i) + " " + std::to_string(i % 977) + ".25 -" + std::to_string(i % 13) + ".5 " +
           std::to_string(i % 65536) + "\n";
}
std::string rows(int begin, int end) {
    std::string text;
    text.reserve(static_cast<std::size_t>(end - begin) * 24);
    for (int i = begin; i < end; ++i)
        text += row(i);
    return text;
}

void requireRows(const Read& read, int count) {
    REQUIRE(read.points.size() == static_cast<std::size_t>(count));
    REQUIRE(read.description.grid.scale == Vec3d{0.01, 0.01, 0.01});
    const Grid& grid = read.description.grid;
    bool same = true;
    for (int i = 0; i < count && same; ++i) {
        Vec3i p = read.points.positions[static_cast<std::size_t>(i)];
        Vec3d at = grid.toWorld(p);
        same = std::abs(at.x - i) < 1e-6 && std::abs(at.y - (i % 977 + 0.25)) < 1e-6 &&
               std::abs(at.z + (i % 13 + 0.5)) < 1e-6;
    }
    REQUIRE(same);
}

// The file by any number of threads, which must not differ in anything.
Read readBy(Opener open, const std::string& text) {
    Read one = readTable(open, text);
    for (int threads : {2, 5}) {
        InputOptions options;
        options.threads = threads;
        auto input = tryOpen(open, bytesOf(text), options);
        REQUIRE(input.ok());
        Read several = readAll(**input);
        CHECK(several.parts == one.parts);
        CHECK((several.points.positions == one.points.positions));
        CHECK((several.points.columns == one.points.columns));
        CHECK(several.description.warnings == one.description.warnings);
        CHECK(several.description.source.format == one.description.source.format);
        CHECK(several.description.bounds == one.description.bounds);
        CHECK(several.description.grid.offset == one.description.grid.offset);
        REQUIRE(several.schema().attributes.size() == one.schema().attributes.size());
        for (std::size_t a = 0; a < one.schema().attributes.size(); ++a)
            CHECK(several.schema().attributes[a].type == one.schema().attributes[a].type);
    }
    return one;
}

std::string refusalBy(int threads, Opener open, const std::string& text) {
    InputOptions options;
    options.threads = threads;
    return refusal(open, text, options);
}

} // namespace

TEST_CASE("text is the same for any number of threads, with comments, empty lines and no last end") {
    std::string text = "x y z intensity\n" + rows(0, 100) + "# a comment\n\n" + rows(100, manyRows);
    text.pop_back();
    Read read = readBy(openTextInput, text);
    requireRows(read, manyRows);
    CHECK(read.parts >= 3);
    CHECK(read.column<std::uint16_t>("Intensity")[70'000] == 70'000 % 65536);
}

TEST_CASE("what is wrong with a line far into a text is told with its number") {
    const std::string good = "x y z intensity\n" + rows(0, manyRows - 1000);
    for (int threads : {1, 2}) {
        // Lines count from 1, and the header is one.
        CHECK(refusalBy(threads, openTextInput, good + "1 2 x 4\n" + rows(0, 1000)) ==
              "scan, line " + std::to_string(manyRows - 1000 + 2) +
                  ": column 3: \"x\" is no number (mend the value, or take the line out)");
        CHECK(refusalBy(threads, openTextInput, good + "1 2\n" + rows(0, 1000))
                  .find("there are 2 columns of 4") != std::string::npos);
    }
}

TEST_CASE("the values of every stretch decide the types of columns and the grid") {
    // Only the last row has a value that needs 32 bits, a third decimal, and a negative number.
    std::string text = "x y z a b\n";
    for (int i = 0; i < manyRows; ++i)
        text += std::to_string(i) + " 1.5 2 " + std::to_string(i % 200) + " 7\n";
    text += "1 2.125 3 70000 -1\n";
    Read read = readBy(openTextInput, text);
    CHECK(read.description.grid.scale.x == 0.001);
    CHECK(read.type("a") == AttributeType::u32);
    CHECK(read.type("b") == AttributeType::i8);
}

TEST_CASE("PTS: one section, several, and counts that are wrong are what they are for one thread") {
    const std::string all = rows(0, manyRows);
    Read one = readBy(openTextInput, std::to_string(manyRows) + "\n" + all);
    requireRows(one, manyRows);
    Read two = readBy(openTextInput, "200000\n" + rows(0, 200'000) + std::to_string(manyRows - 200'000) +
                                         "\n" + rows(200'000, manyRows));
    requireRows(two, manyRows);
    Read more = readBy(openTextInput, "1000\n" + all);
    requireRows(more, manyRows);
    CHECK(more.warns("there are more points than the line above them says"));
    for (int threads : {1, 2})
        CHECK(refusalBy(threads, openTextInput, "1000000\n" + all)
                  .find("promises 1000000 points, but holds 450000") != std::string::npos);
}

TEST_CASE("PTX: scans of all sizes, with empty lines between, are the same for any number of threads") {
    const std::string pose = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
    auto scan = [&](int begin, int end) {
        return std::to_string(end - begin) + "\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n" + pose + rows(begin, end);
    };
    // The first part ends with a scan, the second inside one.
    const int border = 1 << 18;
    std::string text = scan(0, 10) + "\n" + scan(10, border) + "\n\n" + scan(border, border + 5) +
                       scan(border + 5, 2 * border + 100'000);
    Read read = readBy(openPtxInput, text);
    requireRows(read, 2 * border + 100'000);
    CHECK(read.parts >= 2);
    CHECK(read.column<std::uint16_t>("Point Source ID")[border + 4] == 3);
    CHECK(read.column<std::uint16_t>("Point Source ID")[border + 5] == 4);
    for (int threads : {1, 2}) {
        std::string cut = text.substr(0, text.size() - 1000);
        CHECK(refusalBy(threads, openPtxInput, cut).find("scan, line ") == 0);
        CHECK(refusalBy(threads, openPtxInput, text + "1 2\n").find("begins with its numbers") !=
              std::string::npos);
    }
}
