#include "tests/unit/converter/input/read_table.hpp"

#include <cmath>

using namespace stipple;
using namespace stipple::test;

namespace {
std::string scan(int columns, int rows, const std::string& pose, const std::string& points) {
    return std::to_string(columns) + "\n" + std::to_string(rows) + "\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n" + pose +
           points;
}
const std::string unmoved = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
} // namespace

TEST_CASE("PTX: a quarter turn and a shift are applied to the points") {
    Read read = readTable(openPtxInput, scan(1, 2, "0 1 0 0\n-1 0 0 0\n0 0 1 0\n1000.5 2000 30.25 1\n",
                                             "1.25 0 3 0.5\n0 2 -1.125 1.0\n"));
    CHECK(read.description.grid.scale.x == 0.001);
    CHECK(read.world(0) == Vec3d{1000.5, 2001.25, 33.25});
    CHECK(read.world(1) == Vec3d{998.5, 2000, 29.125});
    CHECK(read.column<std::uint16_t>("Intensity") == std::vector<std::uint16_t>{32768, 65535});
    CHECK(read.column<std::uint16_t>("Point Source ID") == std::vector<std::uint16_t>{1, 1});
    CHECK(read.schema().find("Red") < 0);
    CHECK(read.report.maxRounding == 0);
}

TEST_CASE("PTX: several scans keep their numbers; directions without a point are left out") {
    Read read =
        readTable(openPtxInput,
                  scan(2, 2, unmoved, "1 1 1 0 1 2 3\n0 0 0 0.5 0 0 0\n2 2 2 1 4 5 6\n0 0 0 0.5 0 0 0\n") +
                      scan(1, 1, unmoved, "7 7 7 0.25\n") + scan(0, 5, unmoved, "") +
                      scan(1, 1, unmoved, "8 8 8 0.25 255 255 255"));
    CHECK(read.column<std::uint16_t>("Point Source ID") == std::vector<std::uint16_t>{1, 1, 2, 4});
    CHECK(read.column<std::uint16_t>("Red") == std::vector<std::uint16_t>{1, 4, 0, 255});
    CHECK(read.report.invalid == 2);
    CHECK(read.warns("some scans have no colours"));
}

TEST_CASE("PTX: parts begin within scans") {
    std::string points;
    for (int i = 0; i < 300'000; ++i)
        points += std::to_string(i + 1) + " 0 0 0.5\n";
    Read read = readTable(openPtxInput, scan(1000, 300, unmoved, points) +
                                            scan(1000, 300, "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 9 1\n", points));
    CHECK(read.parts == 3);
    CHECK(read.points.positions[299'999] == Vec3i{300'000, 0, 0});
    CHECK(read.points.positions[599'999] == Vec3i{300'000, 0, 9});
}

TEST_CASE("PTX: refusals name the line") {
    auto says = [](const std::string& file, const std::string& words) {
        std::string sentence = refusal(openPtxInput, file);
        INFO(sentence);
        CHECK(sentence.find(words) != std::string::npos);
    };
    says(scan(1, 2, unmoved, "1 2 3 0.5\n"), "line 12: scan 1 ends after 1 of 2 points");
    says(scan(1, 1, unmoved, "1 2 3 0.5\n4 5 6 0.5\n"),
         "line 12: a scan begins with its numbers of columns and rows");
    says(scan(1, 1, unmoved, "1 2\n"), "line 11: points have x y z");
    says(scan(1, 1, unmoved, "1 2 z 0.5\n"), "line 11: column 3: \"z\" is no number");
    says(scan(1, 1, "1 0 0\n", ""), "line 7: this line of a scan's pose should have 4 numbers");
    says(scan(1, 1, "1 0 0 nan\n", ""), "line 7: the pose of a scan is made of finite numbers");
    says("5\n", "scan 1 ends within its header");
}

TEST_CASE("PTX: damaged anywhere, it is refused or read") {
    std::string file =
        scan(1, 2, unmoved, "1 2 3 0.5 1 2 3\n0 0 0 0.5 0 0 0\n") + scan(1, 1, unmoved, "1 2 3 1\n");
    CHECK(damageEverywhere(openPtxInput, bytesOf(file), file.size()) > file.size());
}

TEST_CASE("PTX: files of other programs are read") {
    STIPPLE_NEEDS_DATA();
    Read colour = readFile("1.2-with-color.ptx");
    CHECK(colour.points.size() == 1065);
    CHECK(colour.column<std::uint16_t>("Red")[0] == 68);
    CHECK(colour.description.grid.scale.x == 0.01);
    Read moved = readFile("multiple-and-transform.ptx");
    CHECK(moved.points.size() == 8);
    CHECK(std::abs(moved.world(0).x - 637012.24) < 1e-9);
    CHECK(std::abs(moved.world(0).z - 431.66) < 1e-9);
}
