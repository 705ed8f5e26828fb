#include "client/bench/report.hpp"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>

using namespace stipple;
using namespace stipple::bench;

namespace {

FrameResult frame(double seconds, double error) {
    FrameResult result;
    result.counters.pointsDrawn = 1000;
    result.draw = {seconds, seconds / 2, seconds * 2};
    result.pixels.mean = error;
    result.ssim = 0.5;
    result.change = error + 3;
    result.referenceChange = error + 1;
    return result;
}

BenchResult someResult() {
    BenchResult result;
    result.machine.processor = "a <fast> one";
    result.width = 32;
    result.height = 24;
    result.modes = {builtInModes()[0]};
    result.clouds.push_back(
        {"town", 5000, "00ff", {{0, 0, 0}, {1, 1, 1}}, {{"orbit", {Camera{}, Camera{}}}}});
    result.runs.push_back(
        {"town", "orbit", "default", 1000, "software", {frame(0.010, 5.1), frame(0.030, 10.2)}});
    result.runs.push_back({"town", "walk", "default", 1000, "software", {frame(0.020, 2.55)}});
    result.runs.push_back({"town", "orbit", "default", 2000, "a, b", {frame(0.040, 1)}});
    Image image{2, 1, {255, 0, 0, 255, 0, 255, 0, 255}};
    result.pictures.push_back({"town", "orbit", "default", 1000, 0, image, image, image, image});
    return result;
}

} // namespace

TEST_CASE("summaries take the frames of all paths together") {
    auto summaries = summarise(someResult().runs);
    REQUIRE(summaries.size() == 2);
    CHECK(summaries[0].frames == 3);
    CHECK(summaries[0].drawSeconds == Approx(0.020)); // the median
    CHECK(summaries[0].meanError == Approx((5.1 + 10.2 + 2.55) / 3));
    CHECK(summaries[0].pointsDrawn == 1000);
    CHECK(summaries[0].popping == Approx(2));
    CHECK(summaries[1].budget == 2000);
    CHECK(summaries[1].frames == 1);
}

TEST_CASE("a mode is compared with the one that it names, at the same budget") {
    BenchResult result = someResult();
    Mode lighter = builtInModes()[0];
    lighter.name = "lighter";
    lighter.group = "skips";
    lighter.against = "default";
    result.modes.push_back(lighter);
    result.runs.push_back({"town", "orbit", "lighter", 1000, "software", {frame(0.005, 8)}});
    result.runs.push_back(
        {"town", "orbit", "lighter", 5000, "software", {frame(0.005, 8)}}); // the other was not run
    auto comparisons = compare(summarise(result.runs), result.modes);
    REQUIRE(comparisons.size() == 1);
    CHECK(comparisons[0].mode == "lighter");
    CHECK(comparisons[0].drawSeconds == Approx(0.25));
    CHECK(comparisons[0].pointsDrawn == 1);
    CHECK(comparisons[0].meanError == Approx(8 - (5.1 + 10.2 + 2.55) / 3));
    nlohmann::json json = toJson(result);
    CHECK(json["comparisons"].size() == 1);
    CHECK(json["comparisons"][0]["bytesFetched"].is_null()); // neither has any
    auto html = htmlOf(result);
    REQUIRE(html.ok());
    CHECK(html->find("Time against mean error: skips") != std::string::npos);
    CHECK(html->find("<td>lighter</td><td class=\"text\">default</td><td>0.001 M</td><td>0.250</td>") !=
          std::string::npos);
}

TEST_CASE("the JSON holds every frame") {
    nlohmann::json json = toJson(someResult());
    CHECK(json["runs"].size() == 3);
    CHECK(json["runs"][0]["frames"].size() == 2);
    CHECK(json["runs"][0]["frames"][1]["drawSeconds"]["most"] == Approx(0.06));
    CHECK(json["summaries"].size() == 2);
    CHECK(json["clouds"][0]["paths"][0]["cameras"].size() == 2);
    CHECK(json["machine"]["processor"] == "a <fast> one");
}

TEST_CASE("the CSV has as many fields in each line as names, and quotes what needs it") {
    std::istringstream lines(csvOf(someResult()));
    std::string names, line;
    REQUIRE(std::getline(lines, names));
    auto commas = std::count(names.begin(), names.end(), ',');
    int count = 0;
    for (; std::getline(lines, line); ++count) {
        bool quoted = line.find("\"a, b\"") != std::string::npos;
        CHECK(std::count(line.begin(), line.end(), ',') == commas + (quoted ? 1 : 0));
    }
    CHECK(count == 4);
    CHECK(line.empty());
}

TEST_CASE("the page asks for nothing else and shows text as text") {
    BenchResult result = someResult();
    result.clouds[0].limitations = {"splats: this driver can't do <that>"};
    auto html = htmlOf(result);
    REQUIRE(html.ok());
    CHECK(html->find("<p>splats: this driver can't do &lt;that&gt;.</p>") != std::string::npos);
    CHECK(html->find("a &lt;fast&gt; one") != std::string::npos);
    CHECK(html->find("<fast>") == std::string::npos);
    CHECK(html->find("http") == std::string::npos);
    CHECK(html->find("<script") == std::string::npos);
    // A PNG begins with 89 50 4E 47 0D 0A 1A 0A.
    std::size_t pictures = 0;
    for (std::size_t at = html->find("base64,iVBORw0KGgo"); at != std::string::npos;
         at = html->find("base64,iVBORw0KGgo", at + 1))
        ++pictures;
    CHECK(pictures == 4);
    CHECK(html->find("</html>") != std::string::npos);
}
