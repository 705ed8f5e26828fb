// Points by address against looking at every point.
#include "shared/base/text.hpp"
#include "shared/geometry/corridor.hpp"
#include "shared/geometry/oriented_box.hpp"
#include "tests/unit/server/api/points_oracle.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

using namespace stipple;
using namespace stipple::test;

namespace {

const std::string points = "/api/v1/clouds/small/points";
const std::string profile = "/api/v1/clouds/small/profile";

struct Town : ApiFixture {
    Town() : ApiFixture(quarterTown()) {}
    EveryPoint every{cloud().file};

    // The answer in every format holds the points that `wanted` picks, with every attribute.
    void compare(const std::string& query, const std::function<bool(std::size_t)>& wanted,
                 std::size_t atLeast = 50) const {
        INFO(query);
        PointBatch expected = every.where(wanted);
        CHECK(expected.size() >= atLeast);
        CHECK(expected.size() < every.points.size());
        std::string count = std::to_string(expected.size());
        for (const char* format : {"las", "laz"}) {
            ApiAnswer answer = ask(cat(points, "?", query, "&format=", format));
            REQUIRE(answer.status == 200);
            CHECK(answer.field("Stipple-Point-Count") == count);
            LasAnswer las = lasOf(answer.body);
            CHECK(las.header.compressed == (std::string(format) == "laz"));
            CHECK((las.columnsOf(every.metadata.schema) == expected));
        }
        auto rows = csvRows(ask(points + "?" + query + "&format=csv").body);
        REQUIRE(rows.size() == expected.size() + 1);
        for (std::size_t i = 0; i < expected.size(); i += 17) {
            Vec3d world = every.metadata.grid.toWorld(expected.positions[i]);
            CHECK(std::stod(rows[i + 1][0]) == world.x);
            CHECK(std::stod(rows[i + 1][2]) == world.z);
            CHECK(std::stoi(rows[i + 1][3]) == expected.value<std::uint16_t>(0, i));
        }
        ApiAnswer ply = ask(points + "?" + query + "&format=ply");
        CHECK(ply.field("Stipple-Point-Count") == count);
        CHECK(plyHeader(ply.body).find("element vertex " + count + "\n") != std::string::npos);
    }
};

std::string corners(const BoxD& box) {
    return cat(box.min.x, ",", box.min.y, ",", box.min.z, ",", box.max.x, ",", box.max.y, ",", box.max.z);
}

} // namespace

TEST_CASE("points are chosen by a box, its sides included") {
    Town town;
    BoxD box{{500000, 4000100, 100}, {500400.25, 4000500, 700}};
    town.compare("box=" + corners(box), [&](std::size_t i) { return box.contains(town.every.world(i)); });
    town.compare("box=500000,4000100,500400.25,4000500", [&](std::size_t i) {
        Vec3d p = town.every.world(i);
        return p.x >= 500000 && p.x <= 500400.25 && p.y >= 4000100 && p.y <= 4000500;
    });
}

TEST_CASE("points are chosen by a rotated box") {
    Town town;
    // 3-4-5: the axes are told by whole numbers, but the sides are not hit.
    double degrees = std::atan2(3, 4) * 180 / 3.14159265358979323846;
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", degrees);
    auto wanted = [&](std::size_t i) {
        Vec3d p = town.every.world(i) - Vec3d{500300.1, 4000300.1, 500.1};
        double along = (4 * p.x + 3 * p.y) / 5, across = (4 * p.y - 3 * p.x) / 5;
        return std::abs(along) <= 250 && std::abs(across) <= 100 && std::abs(p.z) <= 400;
    };
    town.compare(cat("center=500300.1,4000300.1,500.1&size=500,200,800&rotation=", text), wanted);
    double half = degrees * 3.14159265358979323846 / 360;
    town.compare(cat("center=500300.1,4000300.1,500.1&size=500,200,800&rotation=0,0,",
                     std::to_string(std::sin(half)), ",", std::to_string(std::cos(half))),
                 wanted);
    town.compare(cat("center=500300.1,4000300.1&size=500,200&minz=100.1&maxz=900.1&rotation=", text), wanted);
}

TEST_CASE("points are chosen by a polygon and heights") {
    Town town;
    auto wanted = [&](std::size_t i) {
        Vec3d p = town.every.world(i);
        bool isIn = p.x >= 500000 && p.y >= 4000000 && (p.x - 500000) + (p.y - 4000000) <= 600;
        return isIn && p.z >= 200 && p.z <= 800;
    };
    for (
        const char* text :
        {"500000,4000000;500600,4000000;500000,4000600",
         "POLYGON ((500000 4000000, 500600 4000000, 500000 4000600, 500000 4000000))",
         R"({"type": "Polygon", "coordinates": [[[500000,4000000],[500600,4000000],[500000,4000600],[500000,4000000]]]})"})
        town.compare("polygon=" + encoded(text) + "&minz=200&maxz=800", wanted);
}

TEST_CASE("points are chosen by a box that is turned in any way") {
    Town town;
    for (int turn = 0; turn < 4; ++turn) {
        auto axes = axesOfQuaternion(0.3 - 0.2 * turn, 0.1 * turn - 0.35, 0.4, 0.25 + 0.3 * turn);
        REQUIRE(axes);
        const Vec3d centre{500300.1, 4000310.1, 500.1}, half{250, 140.5, 330};
        nlohmann::json box{{"centre", {centre.x, centre.y, centre.z}},
                           {"halfSize", {half.x, half.y, half.z}},
                           {"axes", nlohmann::json::array()}};
        for (const Vec3d& axis : *axes)
            box["axes"].push_back({axis.x, axis.y, axis.z});
        town.compare("region=" + encoded(nlohmann::json{{"box", box}}.dump()), [&](std::size_t i) {
            Vec3d p = town.every.world(i) - centre;
            return std::abs(dot(p, (*axes)[0])) <= half.x && std::abs(dot(p, (*axes)[1])) <= half.y &&
                   std::abs(dot(p, (*axes)[2])) <= half.z;
        });
    }
}

TEST_CASE("points are chosen by a footprint with a hole, and by a polygon on the screen") {
    Town town;
    // x + y <= 600 of the corner, without the square between 100 and 200, whose edges belong to the region.
    const char* foot =
        R"({"polygon": [[500000, 4000000], [500600, 4000000], [500000, 4000600]], "heights": [200, null],
        "holes": [[[500100, 4000100], [500200, 4000100], [500200, 4000200], [500100, 4000200]]]})";
    town.compare("maxz=800&region=" + encoded(foot), [&](std::size_t i) {
        Vec3d p = town.every.world(i) - Vec3d{500000, 4000000, 0};
        bool inHole = p.x > 100 && p.x < 200 && p.y > 100 && p.y < 200;
        return p.x >= 0 && p.y >= 0 && p.x + p.y <= 600 && !inHole && p.z >= 200 && p.z <= 800;
    });
    // Seen from 1000 above the ground: a square that is 1 wide for each 2 away.
    const char* prism =
        R"({"prism": {"eye": [500300.1, 4000300.1, 1000.1], "forward": [0, 0, -1], "corners": [
        [500200.1, 4000200.1, 600.1], [500400.1, 4000200.1, 600.1], [500400.1, 4000400.1, 600.1],
        [500200.1, 4000400.1, 600.1]]}})";
    town.compare("region=" + encoded(prism), [&](std::size_t i) {
        Vec3d p = town.every.world(i) - Vec3d{500300.1, 4000300.1, 1000.1};
        return std::max(std::abs(p.x), std::abs(p.y)) <= -p.z / 4;
    });
}

TEST_CASE("points are chosen by values, whatever the order of the query") {
    Town town;
    auto wanted = [&](std::size_t i) {
        double intensity = town.every.value("Intensity", i), source = town.every.value("Point Source ID", i);
        return ((intensity >= 100 && intensity <= 20000) || intensity >= 60000) && source <= 30000;
    };
    town.compare("where=" + encoded("Intensity:100..20000,60000..;Point Source ID:..30000"), wanted);
    town.compare("where=intensity:100..20000,60000..%3Bpoint+source+id:..30000", wanted); // "+" is a space
    std::string box = "box=500000,4000000,500500,4000500";
    std::string one = town.ask(points + "?format=csv&limit=9&" + box).body;
    CHECK(one == town.ask(points + "?" + box + "&limit=9&format=csv").body);
}

TEST_CASE("a spacing is a level of detail, and a limit takes the first points") {
    Town town;
    double root = town.every.metadata.spacing;
    ApiAnswer coarse = town.ask(cat(points, "?format=las&spacing=", root / 2));
    REQUIRE(coarse.status == 200);
    std::size_t coarsePoints = lasOf(coarse.body).points.size();
    CHECK(coarsePoints > 0);
    CHECK(coarsePoints < town.every.points.size() / 2);
    for (std::uint64_t limit : {1u, 400u, 1234u}) {
        std::uint64_t taken = 0;
        town.compare(
            cat("limit=", limit), [&](std::size_t) { return taken++ < limit; }, limit);
    }
}

TEST_CASE("a profile has stations and offsets") {
    Town town;
    std::string line = "500010,4000020;500700,4000100;500650,4000800";
    auto made = Corridor::make({{500010, 4000020}, {500700, 4000100}, {500650, 4000800}}, 120);
    REQUIRE(made.ok());
    auto parts = made->partsNear({{-1e9, -1e9, 0}, {1e9, 1e9, 0}});
    auto wanted = [&](std::size_t i) {
        Vec3d p = town.every.world(i);
        return made->contains({p.x, p.y}, parts);
    };
    PointBatch expected = town.every.where(wanted);
    CHECK(expected.size() > 300);
    for (const char* format : {"las", "laz"}) {
        ApiAnswer answer = town.ask(profile + "?line=" + encoded(line) + "&width=120&format=" + format);
        REQUIRE(answer.status == 200);
        CHECK(answer.field("Content-Disposition") == cat("attachment; filename=small-profile.", format));
        LasAnswer las = lasOf(answer.body);
        CHECK((las.columnsOf(town.every.metadata.schema) == expected));
        int station = las.schema.find("Station"), offset = las.schema.find("Offset");
        REQUIRE(station >= 0);
        REQUIRE(offset >= 0);
        for (std::size_t i = 0; i < las.points.size(); ++i) {
            Vec3d p = town.every.metadata.grid.toWorld(las.points.positions[i]);
            auto place = made->placeOf({p.x, p.y}, parts);
            REQUIRE(place);
            REQUIRE(las.points.value<double>(station, i) == place->station);
            REQUIRE(las.points.value<double>(offset, i) == place->offset);
        }
    }
    auto rows =
        csvRows(town.ask(profile + "?line=" + encoded(line) + "&width=120&format=csv&attributes=none").body);
    CHECK(rows[0] == std::vector<std::string>{"X", "Y", "Z", "Station", "Offset"});
    CHECK(rows.size() == expected.size() + 1);
    // With other conditions.
    auto few = csvRows(
        town.ask(profile + "?line=" + encoded(line) + "&width=120&format=csv&where=Intensity:..9000").body);
    CHECK(few.size() ==
          1 + town.every
                  .where([&](std::size_t i) { return wanted(i) && town.every.value("Intensity", i) <= 9000; })
                  .size());
}

TEST_CASE("attributes are chosen by name") {
    ApiFixture api;
    auto names = [&](const char* query) {
        return csvRows(api.ask(points + "?format=csv&limit=1&" + query).body).at(0);
    };
    CHECK(names("attributes=Red,intensity") == std::vector<std::string>{"X", "Y", "Z", "Red", "Intensity"});
    CHECK(names("attributes=none") == std::vector<std::string>{"X", "Y", "Z"});
}

TEST_CASE("the format is the query's, else that of Accept, else LAS") {
    ApiFixture api;
    struct {
        const char* query;
        const char* accept;
        const char* type;
        const char* name;
    } cases[] = {{"", "", "application/vnd.las", "small-points.las"},
                 {"", "*/*", "application/vnd.las", "small-points.las"},
                 {"", "text/csv", "text/csv; charset=utf-8; header=present", "small-points.csv"},
                 {"", "text/csv;q=0.1, application/vnd.laszip", "application/vnd.laszip", "small-points.laz"},
                 {"&format=ply", "text/csv", "application/x-ply", "small-points.ply"}};
    for (const auto& c : cases) {
        ApiFixture::Fields fields;
        if (*c.accept)
            fields.emplace_back("Accept", c.accept);
        ApiAnswer answer = api.ask(cat(points, "?limit=5", c.query), fields);
        INFO(c.query << " " << c.accept);
        CHECK(answer.status == 200);
        CHECK(answer.field("Content-Type") == c.type);
        CHECK(answer.field("Content-Disposition") == cat("attachment; filename=", c.name));
        CHECK(answer.field("Vary") == (*c.query ? "" : "Accept"));
    }
    CHECK(api.ask(points, {{"Accept", "image/png"}}).status == 406);
}

TEST_CASE("an answer has a tag that the same question finds again") {
    ApiFixture api;
    std::string target = points + "?limit=5&format=csv";
    std::string tag = api.ask(target).field("ETag");
    CHECK(tag.size() > 10);
    CHECK(api.ask(target, {{"If-None-Match", tag}}).status == 304);
    CHECK(api.ask(points + "?format=csv&limit=5", {{"If-None-Match", tag}}).status == 304);
    CHECK(api.ask(points + "?limit=6&format=csv", {{"If-None-Match", tag}}).status == 200);
    CHECK(api.ask(points + "?limit=5&format=ply", {{"If-None-Match", tag}}).status == 200);
    CHECK(api.ask(target + "&version=0").status == 410);
    CHECK(api.ask(target + "&version=" + api.version()).field("Cache-Control").find("immutable") !=
          std::string::npos);
}

TEST_CASE("nothing found is a valid file of no points") {
    ApiFixture api;
    std::string query = "?box=-9,-9,-8,-8&format=";
    CHECK(lasOf(api.ask(points + query + "las").body).points.size() == 0);
    CHECK(lasOf(api.ask(points + query + "laz").body).points.size() == 0);
    CHECK(csvRows(api.ask(points + query + "csv").body).size() == 1);
    CHECK(plyHeader(api.ask(points + query + "ply").body).find("element vertex 0\n") != std::string::npos);
}

TEST_CASE("a parameter that means nothing is named, with what is allowed") {
    ApiFixture api;
    auto refusal = [&](const std::string& target) {
        ApiAnswer answer = api.ask(target);
        INFO(target << ": " << answer.body.substr(0, 300));
        CHECK(answer.status == 400);
        CHECK(answer.field("Content-Type") == "application/problem+json");
        return answer.json.value("parameter", "none");
    };
    for (auto [query, parameter] : std::initializer_list<std::pair<const char*, const char*>>{
             {"box=1,2,3", "box"},
             {"box=1,2,3,nan", "box"},
             {"box=1,2,3,inf", "box"},
             {"box=5,0,4,1", "box"},
             {"box=0,0,5,1,1,4", "box"},
             {"box=0,0,1,1&box=0,0,1,1", "box"},
             {"bocks=0,0,1,1", "bocks"},
             {"center=1,2", "size"},
             {"size=1,2", "center"},
             {"rotation=5", "center"},
             {"center=1,2&size=1,2,3", "size"},
             {"center=1,2&size=1,-2", "size"},
             {"center=1,2&size=1,2&rotation=1,2", "rotation"},
             {"center=1,2&size=1,2&rotation=0,0,0,1", "rotation"},
             {"center=1,2,3&size=1,2,3&rotation=0,0,0,0", "rotation"},
             {"center=1e200,2&size=1,2", "center"},
             {"polygon=1,2", "polygon"},
             {"polygon=%7B%22type%22", "polygon"},
             {"polygon=POINT+(1+2)", "polygon"},
             {"region=7", "region"},
             {"region=%7B", "region"},
             {"region=%7B%22circle%22:1%7D", "region"},
             {"region=%7B%22polygon%22:[[0,0],[1,1]]%7D", "region"},
             {"region=%7B%22polygon%22:[[0,0],[1,1],[1,0]]%7D&polygon=0,0;1,1;1,0", "region"},
             {"region=%7B%22heights%22:[0,1]%7D&minz=2", "region"},
             {"minz=x", "minz"},
             {"minz=5&maxz=4", "maxz"},
             {"box=0,0,0,1,1,1&minz=5", "minz"},
             {"box=0,0,5,1,1,6&maxz=4", "maxz"},
             {"class=2", "class"}, // the cloud has none
             {"class=x", "class"},
             {"where=Height:1..2", "where"},
             {"where=Intensity:2..1", "where"},
             {"where=Intensity", "where"},
             {"spacing=0", "spacing"},
             {"spacing=-1", "spacing"},
             {"limit=0", "limit"},
             {"limit=-1", "limit"},
             {"limit=1.5", "limit"},
             {"limit=100000001", "limit"},
             {"attributes=Height", "attributes"},
             {"format=xyz", "format"}})
        CHECK(refusal(points + "?" + query) == parameter);
    for (auto [query, parameter] : std::initializer_list<std::pair<const char*, const char*>>{
             {"", "line"},
             {"line=0,0;1,1", "width"},
             {"width=5", "line"},
             {"line=0,0;1,1&width=0", "width"},
             {"line=0,0&width=5", "line"},
             {"line=0,0;0,0&width=5", "line"},
             {"line=0,0;1&width=5", "line"},
             {"line=0,0;1e200,1&width=5", "line"},
             {"line=0,0;1,1&width=5&center=1,2", "center"}})
        CHECK(refusal(profile + "?" + query) == parameter);
    ApiAnswer missing = api.ask(profile + "?width=5");
    CHECK(missing.json["type"] == "/api/v1/problems/missing-parameter");
    CHECK(api.ask(points + "?box=1,2,3").json["detail"] ==
          "box: it has 3 numbers (give minx,miny,minz,maxx,maxy,maxz or minx,miny,maxx,maxy)");
}

TEST_CASE("more points than the server gives are refused before they are made") {
    server::ApiLimits limits;
    limits.points.maxPoints = 1000;
    ApiFixture api(quarterTown(), limits);
    for (const char* format : {"las", "laz", "csv", "ply"}) {
        ApiAnswer answer = api.ask(points + "?format=" + format);
        CHECK(answer.status == 400);
        CHECK(answer.json["type"] == "/api/v1/problems/work-too-large");
        CHECK(answer.json["detail"].get<std::string>().find("34000 points") != std::string::npos);
        CHECK(api.ask(points + "?limit=1000&format=" + format).status == 200);
    }
    CHECK(api.ask(points + "?limit=1001").json["parameter"] == "limit");
    // The nodes touched hold more, the region does not.
    CHECK(api.ask(points + "?format=csv&box=500000,4000000,500020,4000020").status == 200);
}

TEST_CASE("more bytes than the server gives are refused, or end the answer") {
    server::ApiLimits limits;
    limits.points.maxBytes = 20000;
    ApiFixture api(quarterTown(), limits);
    for (const char* format : {"las", "laz", "ply"}) {
        ApiAnswer answer = api.ask(points + "?format=" + format);
        CHECK(answer.status == 400);
        CHECK(answer.json["type"] == "/api/v1/problems/work-too-large");
    }
    CHECK(api.ask(points + "?limit=100&format=las").status == 200);
    CHECK(api.ask(points + "?limit=100&format=laz").status == 200);
    ApiAnswer cut = api.ask(points + "?format=csv"); // nobody knows before
    CHECK(cut.body.size() <= 20000);
}

TEST_CASE("room for temporary files is given back when the answer has gone") {
    server::ApiLimits limits;
    limits.scratchBytes = 3'000'000;
    ApiFixture api(quarterTown(), limits);
    {
        ApiAnswer answer = api.ask(points + "?format=laz");
        REQUIRE(answer.status == 200);
        CHECK(api.resources().scratch->usedBytes() == answer.body.size());
    }
    CHECK(api.resources().scratch->usedBytes() == 0);
    limits.scratchBytes = 1000;
    ApiFixture small(quarterTown(), limits);
    ApiAnswer full = small.ask(points + "?format=laz");
    CHECK(full.status == 503);
    CHECK(full.field("Retry-After") == "10");
    CHECK(small.resources().scratch->usedBytes() == 0);
    limits.scratchFolder = "/nowhere/at/all";
    ApiFixture nowhere(quarterTown(), limits);
    ApiAnswer unwritable = nowhere.ask(points + "?format=laz");
    CHECK(unwritable.status == 503);
    CHECK(unwritable.body.find("nowhere") == std::string::npos);
}

TEST_CASE("several threads give the same bytes") {
    ApiFixture one(quarterTown());
    server::ApiLimits limits;
    limits.points.threads = 3;
    ApiFixture three(quarterTown(), limits);
    for (const char* format : {"las", "laz", "csv", "ply"}) {
        std::string target = points + "?box=500000,4000000,500400,4000400&format=" + format;
        CHECK((one.ask(target).body == three.ask(target).body));
    }
}
