#include "converter/synth/random.hpp"
#include "converter/synth/scene.hpp"

#include <catch2/catch.hpp>

#include <set>

using namespace stipple;
using namespace stipple::synth;

namespace {

std::unique_ptr<const Scene> smallScene(SceneKind kind) {
    return Scene::make(kind, 3, 300);
}

} // namespace

TEST_CASE("hits come in order of distance, lie on the surface, and end at the first opaque one") {
    for (SceneKind kind : {SceneKind::town, SceneKind::indoor, SceneKind::terrain}) {
        auto scene = smallScene(kind);
        Random random(4);
        const auto& b = scene->bounds();
        std::size_t hitCount = 0;
        for (int k = 0; k < 3000; ++k) {
            auto inside = [&](double from, double to, double t) { return from + (to - from) * t; };
            Vec3d from{inside(static_cast<double>(b.min.x), static_cast<double>(b.max.x), random.uniform()),
                       inside(static_cast<double>(b.min.y), static_cast<double>(b.max.y), random.uniform()),
                       static_cast<double>(b.max.z) + random.uniform(-4, 300)};
            Ray ray{from, normalized({random.normal(), random.normal(), -2})};
            HitList hits;
            scene->castRay(ray, 1e4, hits);
            double before = 0;
            for (const Hit& hit : hits) {
                REQUIRE(hit.distance > 0);
                REQUIRE(hit.distance >= before);
                before = hit.distance;
                REQUIRE(scene->distanceToSurface(hit.position) < 1e-6);
                REQUIRE(dot(hit.normal, ray.direction) <= 0);
                bool last = &hit + 1 == hits.end();
                Interception how = materialInfo(hit.material).interception;
                if (!last)
                    REQUIRE((how == Interception::partial || how == Interception::pane));
                ++hitCount;
            }
        }
        CHECK(hitCount > 1000);
    }
}

TEST_CASE("the ground's height is what a ray from above meets where nothing stands") {
    auto scene = smallScene(SceneKind::terrain);
    Random random(5);
    int compared = 0;
    for (int k = 0; k < 500; ++k) {
        double x = random.uniform(-140, 140), y = random.uniform(-140, 140);
        auto height = scene->heightAt(x, y);
        REQUIRE(height.has_value());
        HitList hits;
        scene->castRay({{x, y, 1000}, {0, 0, -1}}, 2000, hits);
        REQUIRE(hits.size > 0);
        const Hit& first = hits.hits[0];
        REQUIRE(first.position.z >= *height - 1e-9);
        if (first.object == 0) {
            REQUIRE(first.position.z == Approx(*height).margin(1e-9));
            ++compared;
        }
    }
    CHECK(compared > 50);
    CHECK_FALSE(scene->heightAt(5000, 0).has_value());
    CHECK_FALSE(smallScene(SceneKind::indoor)->heightAt(5, 5).has_value());
}

TEST_CASE("nothing is seen through a wall") {
    auto scene = smallScene(SceneKind::indoor);
    // From inside the building, 60 m in any direction below the horizon: never further than the floor.
    Vec3d eye = scene->stations().at(0);
    Random random(6);
    for (int k = 0; k < 2000; ++k) {
        Vec3d direction = normalized({random.normal(), random.normal(), -std::abs(random.normal()) - 0.3});
        HitList hits;
        scene->castRay({eye, direction}, 1000, hits);
        REQUIRE(hits.size > 0);
        double floor = (eye.z + 0.35) / -direction.z; // the lawn outside is the lowest surface
        CHECK(hits.hits[hits.size - 1].distance <= floor + 1e-6);
    }
}

TEST_CASE("stations stand clear of everything") {
    for (SceneKind kind : {SceneKind::town, SceneKind::indoor}) {
        auto scene = smallScene(kind);
        CHECK(scene->stations().size() > 5);
        for (Vec3d station : scene->stations())
            CHECK(scene->distanceToSurface(station) > 0.45);
    }
    CHECK(smallScene(SceneKind::indoor)->stations().size() > 50); // a room each, and the corridors
}

TEST_CASE("a scene depends on its seed and nothing else") {
    auto a = Scene::make(SceneKind::town, 1, 300), b = Scene::make(SceneKind::town, 1, 300),
         other = Scene::make(SceneKind::town, 2, 300);
    CHECK(a->primitiveCount() == b->primitiveCount());
    CHECK(a->bounds() == b->bounds());
    CHECK(a->primitiveCount() != other->primitiveCount());
    for (double x = -100; x < 100; x += 37)
        CHECK(a->heightAt(x, 20) == b->heightAt(x, 20));
}
