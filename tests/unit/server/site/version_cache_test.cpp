#include "server/site/version_cache.hpp"

#include <catch2/catch.hpp>

using namespace stipple::server;

namespace {

std::shared_ptr<const CloudVersion> version(std::size_t metadataBytes = 10) {
    auto made = std::make_shared<CloudVersion>();
    made->metadataText.assign(metadataBytes, 'x');
    return made;
}

std::string held(VersionCache& cache) {
    std::string ids;
    for (const char* id : {"a", "b", "c", "d"})
        if (cache.find(id))
            ids += id;
    return ids;
}

} // namespace

TEST_CASE("the versions used last are kept") {
    VersionCache cache({2, 1000});
    auto a = version();
    cache.keep("a", a);
    cache.keep("b", version());
    CHECK(cache.find("a") == a);
    cache.keep("c", version());
    CHECK(held(cache) == "ac");
    CHECK(cache.size() == 2);
}

TEST_CASE("large documents take the place of several small ones, but one is always kept") {
    VersionCache cache({10, 100});
    for (const char* id : {"a", "b", "c"})
        cache.keep(id, version(30));
    cache.keep("d", version(60));
    CHECK(held(cache) == "cd");
    cache.keep("a", version(5000));
    CHECK(held(cache) == "a");
    cache.keep("b", version(50));
    CHECK(held(cache) == "b");
    cache.keep("c", version(50));
    CHECK(held(cache) == "bc");
}

TEST_CASE("a new version takes the place of the old, which lives as long as it is used") {
    VersionCache cache({2, 1000});
    auto old = version(), fresh = version();
    cache.keep("a", old);
    cache.keep("a", fresh);
    CHECK(cache.size() == 1);
    CHECK(cache.find("a") == fresh);
    CHECK(old.use_count() == 1);
}

TEST_CASE("versions can be dropped, singly and all but the last ones") {
    VersionCache cache({10, 1000});
    for (const char* id : {"a", "b", "c", "d"})
        cache.keep(id, version());
    cache.drop("b");
    cache.drop("none");
    CHECK(cache.size() == 3);
    cache.shrinkTo(1);
    CHECK(held(cache) == "d");
    cache.shrinkTo(0);
    CHECK(cache.size() == 0);
}
