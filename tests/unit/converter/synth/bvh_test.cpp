#include "converter/synth/bvh.hpp"
#include "converter/synth/intersect.hpp"
#include "converter/synth/model.hpp"
#include "converter/synth/random.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::synth;

namespace {

Model scatter(std::size_t count, std::uint64_t seed) {
    Random random(seed);
    Model m;
    for (std::size_t i = 0; i < count; ++i) {
        Vec3d at{random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(0, 10)};
        if (i % 2 == 0)
            m.disc(at, {random.normal(), random.normal(), random.normal()}, random.uniform(0.1, 2),
                   Material::leafBroad);
        else
            m.triangle(at, at + Vec3d{random.normal(), random.normal(), random.normal()},
                       at + Vec3d{random.normal(), random.normal(), random.normal()}, Material::wall);
    }
    return m;
}

struct Searcher {
    explicit Searcher(const Model& from) : model(from) {
        for (const Primitive& p : model.primitives)
            boxes.push_back(boundsOf(p));
        bvh = Bvh(boxes, order);
    }
    double nearest(const Ray& ray) const {
        double limit = noHit;
        bvh.traverse(ray, limit, [&](std::uint32_t first, std::uint32_t count) {
            for (std::uint32_t i = first; i < first + count; ++i)
                limit = std::min(limit, intersect(model.primitives[order[i]], ray, 0));
        });
        return limit;
    }
    const Model& model;
    std::vector<Box<float>> boxes;
    std::vector<std::uint32_t> order;
    Bvh bvh;
};

} // namespace

TEST_CASE("the hierarchy finds what a search over all primitives finds") {
    for (std::size_t count :
         {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{5}, std::size_t{3000}}) {
        Model m = scatter(count, count + 5);
        Searcher searcher(m);
        Random random(9);
        for (int k = 0; k < 300; ++k) {
            Ray ray{{random.uniform(-60, 60), random.uniform(-60, 60), random.uniform(-5, 400)}, {}};
            Vec3d target{random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(0, 10)};
            // Some rays run exactly along an axis.
            ray.direction = k % 5 == 0 ? Vec3d{0, 0, -1} : normalized(target - ray.origin);
            double all = noHit, near = noHit;
            for (const Primitive& p : m.primitives) {
                all = std::min(all, intersect(p, ray, 0));
                near = std::min(near, distanceTo(p, ray.origin));
            }
            REQUIRE(searcher.nearest(ray) == all);
            double limit = noHit;
            searcher.bvh.approach(ray.origin, limit, [&](std::uint32_t first, std::uint32_t size) {
                for (std::uint32_t i = first; i < first + size; ++i)
                    limit = std::min(limit, distanceTo(m.primitives[searcher.order[i]], ray.origin));
            });
            REQUIRE(limit == near);
        }
    }
}

TEST_CASE("items in one place do not hang the build") {
    Model m;
    for (int i = 0; i < 500; ++i)
        m.sphere({1, 1, 1}, 0.5, Material::wall);
    Searcher searcher(m);
    CHECK(searcher.nearest({{1, 1, 10}, {0, 0, -1}}) == Approx(8.5));
}
