#include "client/core/load_value.hpp"

#include "client/core/camera.hpp"
#include "tests/support/small_cloud.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::test;

namespace {

struct Scene {
    SmallCloud cloud = makeSmallCloud({.levels = 3, .pointsPerNode = 800});
    Hierarchy hierarchy;

    Scene() {
        auto made = Hierarchy::create(std::make_shared<CloudMetadata>(cloud.metadata), cloud.nodes);
        REQUIRE(made.ok());
        hierarchy = std::move(*made);
    }
    ViewTransform view(const Camera& camera) const {
        return viewTransform(camera, 800, 600, cloud.metadata.worldBounds());
    }
    ViewTransform top() const {
        return view(namedCamera(NamedView::top, cloud.metadata.worldBounds(), 800.0 / 600));
    }
    double value(const ViewTransform& from, const std::string& key, std::uint32_t begin,
                 std::uint32_t end) const {
        for (std::size_t i = 0; i < hierarchy.size(); ++i)
            if (hierarchy.node(i).entry.key.text() == key)
                return loadValue(from, 600, hierarchy, i, begin, end);
        FAIL("no such node");
        return 0;
    }
};

} // namespace

TEST_CASE("coarse points are worth more than fine ones, of a node and of its children") {
    Scene scene;
    ViewTransform view = scene.top();
    double last = HUGE_VAL;
    for (int strata = 0; strata < strataCount; ++strata) {
        std::uint32_t from = strataPrefixPoints(800, strata), to = strataPrefixPoints(800, strata + 1);
        double each = scene.value(view, "1-0-0-0", from, to) / (to - from);
        CHECK(each < last);
        CHECK(each > 0);
        last = each;
    }
    CHECK(scene.value(view, "0-0-0-0", 0, 100) > scene.value(view, "1-0-0-0", 0, 100));
    CHECK(scene.value(view, "1-0-0-0", 0, 100) > scene.value(view, "2-0-0-0", 0, 100));
}

TEST_CASE("what is near and what is in view is worth more; what is hardly in view a little") {
    Scene scene;
    BoxD box = scene.cloud.metadata.worldBounds();
    double size = length(box.max - box.min);
    Camera camera;
    camera.position = box.min + Vec3d{0.12, -0.1, 0.05} * size;
    camera.target = camera.position + Vec3d{0, size, 0};
    ViewTransform view = scene.view(camera);
    double front = scene.value(view, "2-0-0-0", 0, 100), back = scene.value(view, "2-0-3-0", 0, 100),
           aside = scene.value(view, "2-3-0-0", 0, 100);
    CHECK(front > back);
    CHECK(front > aside);
    CHECK(back > 0);
    CHECK(aside > 0);
}

TEST_CASE("of what takes as much of the picture the nearer is worth more, since it hides the other") {
    Scene scene;
    BoxD box = scene.cloud.metadata.worldBounds();
    double size = length(box.max - box.min);
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.orthoHeight = 2 * size;
    camera.target = box.min + (box.max - box.min) * 0.5;
    camera.position = camera.target - Vec3d{0, size, 0};
    ViewTransform view = scene.view(camera);
    double front = scene.value(view, "2-0-0-0", 0, 100), back = scene.value(view, "2-0-3-0", 0, 100);
    CHECK(front > 1.02 * back);
    CHECK(front < 4 * back);
}
