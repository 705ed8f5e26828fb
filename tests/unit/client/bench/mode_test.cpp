#include "client/bench/mode.hpp"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

using namespace stipple;
using namespace stipple::bench;
using nlohmann::json;

TEST_CASE("the table of modes can be read; names are unique and say something") {
    std::set<std::string> names;
    bool swept = false, gles = false;
    for (const Mode& mode : builtInModes()) {
        CHECK(names.insert(mode.name).second);
        CHECK(mode.about.size() > 5);
        swept |= mode.sweep;
        gles |= mode.backend == headless::Backend::gles;
    }
    CHECK(names.size() >= 10);
    CHECK(swept);
    CHECK(gles);
    CHECK(builtInModes().front().style == Style{});
}

TEST_CASE("modes are compared with modes that are there, and every skip has one without it") {
    Skips all, without;
    for (const Mode& mode : builtInModes()) {
        INFO(mode.name);
        auto named = [&](const Mode& other) { return other.name == mode.against; };
        CHECK((mode.against.empty() || std::any_of(builtInModes().begin(), builtInModes().end(), named)));
        CHECK((mode.against.empty() || !mode.group.empty()));
        const Skips& skips = mode.limits.skips;
        CHECK((skips == all || mode.group == "skips"));
        without.unseen &= skips.unseen;
        without.clipped &= skips.clipped;
        without.hidden &= skips.hidden;
        without.tooFine &= skips.tooFine;
        without.unused &= skips.unused;
    }
    CHECK(without == Skips{false, false, false, false, false});
}

TEST_CASE("modes survive JSON, and wrong ones are refused by name") {
    json list = json::array();
    for (const Mode& mode : builtInModes())
        list.push_back(toJson(mode));
    for (json& mode : list) // ranges that are left to the cloud have no JSON of their own
        for (const char* range : {"intensityRange", "elevationRange"})
            REQUIRE(mode["style"][range].is_null());
    auto back = modesFromJson(list);
    REQUIRE(back.ok());
    REQUIRE(back->size() == builtInModes().size());
    for (std::size_t i = 0; i < back->size(); ++i)
        CHECK(toJson((*back)[i]) == list[i]);

    for (const char* text :
         {"{}", R"([{"about": "nameless"}])", R"([{"name": "a", "style": {"size": 3}}])",
          R"([{"name": "a", "backend": "vulkan"}])", R"([{"name": "a", "swept": true}])",
          R"([{"name": "a", "limits": {"minNodePixels": -1}}])", R"([5])",
          R"([{"name": "a", "without": ["frustum"]}])", R"([{"name": "a", "without": "unseen"}])"}) {
        INFO(text);
        auto read = modesFromJson(json::parse(text));
        REQUIRE_FALSE(read.ok());
        CHECK(read.error().code == ErrorCode::invalidArgument);
    }
}
