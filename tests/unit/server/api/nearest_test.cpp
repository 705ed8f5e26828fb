// Picking by address against looking at every point.
#include "shared/base/text.hpp"
#include "tests/unit/server/api/points_oracle.hpp"

#include <algorithm>
#include <cmath>

using namespace stipple;
using namespace stipple::test;

namespace {

const std::string nearest = "/api/v1/clouds/small/nearest";

struct Ranked {
    double rank;
    std::size_t point;
};

struct Town : ApiFixture {
    Town() : ApiFixture(quarterTown()) {}
    EveryPoint every{cloud().file};

    // Best first, of those with a rank of at least 0.
    std::vector<Ranked> best(std::size_t count, const std::function<double(Vec3d)>& rankOf,
                             const std::function<bool(std::size_t)>& wanted) const {
        std::vector<Ranked> ranked;
        for (std::size_t i = 0; i < every.points.size(); ++i)
            if (double rank = rankOf(every.world(i)); rank >= 0 && wanted(i))
                ranked.push_back({rank, i});
        std::stable_sort(ranked.begin(), ranked.end(), [&](const Ranked& a, const Ranked& b) {
            if (a.rank != b.rank)
                return a.rank < b.rank;
            return std::pair(every.nodes[a.point], every.indices[a.point]) <
                   std::pair(every.nodes[b.point], every.indices[b.point]);
        });
        ranked.resize(std::min(ranked.size(), count));
        return ranked;
    }

    void compare(const std::string& query, const std::vector<Ranked>& expected, const char* rankName) const {
        INFO(query);
        ApiAnswer answer = ask(nearest + "?" + query);
        REQUIRE(answer.status == 200);
        CHECK(answer.field("Content-Type") == "application/json");
        CHECK(answer.json["id"] == "small");
        const auto& found = answer.json["points"];
        REQUIRE(found.size() == expected.size());
        for (std::size_t k = 0; k < expected.size(); ++k) {
            std::size_t i = expected[k].point;
            Vec3i grid = every.points.positions[i];
            Vec3d world = every.world(i);
            CHECK(found[k]["node"] == every.nodes[i].text());
            CHECK(found[k]["index"] == every.indices[i]);
            CHECK(found[k]["grid"] == nlohmann::json{grid.x, grid.y, grid.z});
            CHECK(found[k]["position"] == nlohmann::json{world.x, world.y, world.z});
            CHECK(found[k][rankName].get<double>() == expected[k].rank);
            CHECK(found[k]["attributes"].size() == every.metadata.schema.attributes.size());
            for (const char* name : {"Intensity", "Point Source ID", "Red", "Green", "Blue"})
                CHECK(found[k]["attributes"][name] == every.value(name, i));
        }
        CHECK(answer.json["read"]["nodes"].get<std::size_t>() <= cloud().nodes.size());
    }
};

bool always(std::size_t) {
    return true;
}

std::string text(Vec3d v) {
    char buffer[120];
    std::snprintf(buffer, sizeof buffer, "%.17g,%.17g,%.17g", v.x, v.y, v.z);
    return buffer;
}

} // namespace

TEST_CASE("the nearest points to a place, with their attributes") {
    Town town;
    for (Vec3d place :
         {Vec3d{500100, 4000100, 300}, Vec3d{500555.5, 4000020.25, 1000}, Vec3d{499000, 4001000, 0}}) {
        auto distance = [&](Vec3d p) { return length(p - place); };
        auto flat = [&](Vec3d p) { return std::hypot(p.x - place.x, p.y - place.y); };
        auto check = [&](const std::string& query, std::size_t count, auto rank, auto wanted) {
            auto expected = town.best(count, rank, wanted);
            // length() sums in another order than a plain loop may: ranks are compared as the server has
            // them.
            for (Ranked& r : expected) {
                Vec3d d = town.every.world(r.point) - place;
                double plane = d.x * d.x + d.y * d.y;
                r.rank = std::sqrt(query.find("plan") != std::string::npos ? plane : plane + d.z * d.z);
            }
            town.compare(query.substr(query.find('|') + 1), expected, "distance");
        };
        check("|point=" + text(place), 1, distance, always);
        check("|point=" + text(place) + "&count=25", 25, distance, always);
        check(cat("plan|count=5&point=", std::to_string(place.x), ",", std::to_string(place.y)), 5, flat,
              always);
        check("|point=" + text(place) + "&count=9&where=Intensity:..3000", 9, distance,
              [&](std::size_t i) { return town.every.value("Intensity", i) <= 3000; });
        check("|point=" + text(place) + "&count=9&box=500300,4000300,500600,4000600", 9, distance,
              [&](std::size_t i) {
                  Vec3d p = town.every.world(i);
                  return p.x >= 500300 && p.x <= 500600 && p.y >= 4000300 && p.y <= 4000600;
              });
    }
    ApiAnswer none = town.ask(nearest + "?point=0,0,0&maxdistance=100");
    CHECK(none.status == 200);
    CHECK(none.json["points"].empty());
    CHECK(none.json["read"]["nodes"] == 0);
}

TEST_CASE("the first points along a ray, within a radius or an angle") {
    Town town;
    Vec3d origin{500050, 4000060, 1500};
    for (Vec3d direction : {Vec3d{3, 4, -12}, Vec3d{0, 0, -1}, Vec3d{1, 1, -1}}) {
        Vec3d unit = normalized(direction);
        for (double radius : {20.0, 60.0})
            for (bool asAngle : {false, true}) {
                double slope = std::tan((radius / 10) * 3.14159265358979323846 / 180);
                auto along = [&](Vec3d p) {
                    Vec3d from = p - origin;
                    double t = (from.x * unit.x + from.y * unit.y) + from.z * unit.z;
                    double apart = length(cross(from, unit));
                    return apart <= (asAngle ? slope * t : radius) ? t : -1;
                };
                std::string query = cat("origin=", text(origin), "&direction=", text(direction), "&count=7&",
                                        asAngle ? "angle=" : "radius=", asAngle ? radius / 10 : radius);
                town.compare(query, town.best(7, along, always), "along");
            }
    }
}

TEST_CASE("attributes that are asked for are those that come") {
    Town town;
    ApiAnswer answer = town.ask(nearest + "?point=500100,4000100,300&attributes=Red,Intensity");
    REQUIRE(answer.status == 200);
    CHECK(answer.json["points"][0]["attributes"].size() == 2);
    CHECK(town.ask(nearest + "?point=500100,4000100,300&attributes=none")
              .json["points"][0]["attributes"]
              .empty());
}

TEST_CASE("a pick that means nothing names the parameter") {
    ApiFixture api;
    for (auto [query, parameter] : std::initializer_list<std::pair<const char*, const char*>>{
             {"", "point"},
             {"point=1", "point"},
             {"point=1,2,nan", "point"},
             {"point=1,2,1e200", "point"},
             {"point=1,2,3&origin=1,2,3", "origin"},
             {"point=1,2,3&radius=1", "radius"},
             {"direction=1,2,3", "origin"},
             {"origin=1,2,3", "direction"},
             {"origin=1,2,3&direction=0,0,0&radius=1", "direction"},
             {"origin=1,2,3&direction=1,0,0", "radius"},
             {"origin=1,2,3&direction=1,0,0&radius=-1", "radius"},
             {"origin=1,2,3&direction=1,0,0&radius=1&angle=1", "angle"},
             {"origin=1,2,3&direction=1,0,0&angle=81", "angle"},
             {"point=1,2,3&count=0", "count"},
             {"point=1,2,3&count=1001", "count"},
             {"point=1,2,3&maxdistance=-1", "maxdistance"},
             {"point=1,2,3&where=x", "where"},
             {"point=1,2,3&limit=5", "limit"}}) {
        ApiAnswer answer = api.ask(nearest + "?" + query);
        INFO(query << ": " << answer.body.substr(0, 300));
        CHECK(answer.status == 400);
        CHECK(answer.json.value("parameter", "none") == parameter);
    }
}

TEST_CASE("a pick has a tag that the same question finds again") {
    ApiFixture api;
    std::string target = nearest + "?point=1,2,3";
    std::string tag = api.ask(target).field("ETag");
    CHECK(api.ask(target, {{"If-None-Match", tag}}).status == 304);
    CHECK(api.ask(target + "&count=2", {{"If-None-Match", tag}}).status == 200);
}
