#include "converter/synth/ordered_blocks.hpp"
#include "converter/synth/scan_block.hpp"
#include "converter/synth/synthesize.hpp"

#include <catch2/catch.hpp>

#include <map>
#include <set>

using namespace stipple;
using namespace stipple::synth;

namespace {

struct Scan {
    std::unique_ptr<const Scene> scene;
    SynthReport report;
    std::vector<PointBatch> batches;
};

Scan scanOf(SynthOptions options) {
    Scan scan;
    scan.scene = Scene::make(options.scene, options.seed, sideFor(options.scene, options.points));
    auto report = scanScene(*scan.scene, options,
                            [&](const PointBatch& batch) {
                                scan.batches.push_back(batch);
                                return Status{};
                            },
                            {});
    REQUIRE(report.ok());
    scan.report = *report;
    return scan;
}

Scan scanOf(SceneKind kind, std::uint64_t points, double noiseMeters = 0) {
    SynthOptions options;
    options.scene = kind;
    options.points = points;
    options.seed = 5;
    options.noiseMeters = noiseMeters;
    return scanOf(options);
}

template <class Use>
void eachPoint(const Scan& scan, const Use& use) {
    for (const PointBatch& batch : scan.batches)
        for (std::size_t i = 0; i < batch.size(); ++i)
            use(batch, i);
}

const SceneKind allKinds[] = {SceneKind::town, SceneKind::indoor, SceneKind::terrain};

} // namespace

TEST_CASE("without noise every point lies on the exact surface, to half a step of the grid") {
    for (SceneKind kind : allKinds) {
        Scan scan = scanOf(kind, 40'000);
        // Half a millimetre along each axis, and 1e-6 m for the arithmetic.
        const double bound = 0.0005 * std::sqrt(3.0) + 1e-6;
        double worst = 0;
        eachPoint(scan, [&](const PointBatch& batch, std::size_t i) {
            Vec3i p = batch.positions[i];
            Vec3d at{static_cast<double>(p.x) * 0.001, static_cast<double>(p.y) * 0.001,
                     static_cast<double>(p.z) * 0.001};
            worst = std::max(worst, scan.scene->distanceToSurface(at));
        });
        CHECK(worst < bound);
        CHECK(worst > 0);
    }
}

TEST_CASE(
    "before rounding, noise-free returns are on the surface within a micrometre and nothing hides them") {
    for (SceneKind kind : allKinds) {
        auto scene = Scene::make(kind, 5, 300);
        Scanner scanner(*scene, 5, 0);
        std::vector<Return> returns;
        std::size_t opaque = 0;
        for (Source source : planSources(*scene)) {
            planPulses(source, 400);
            for (std::uint64_t index = 0; index < source.pulses(); ++index) {
                Pulse pulse = pulseOf(source, 5, index);
                scanner.measure(source, index, pulse, returns);
                for (const Return& r : returns) {
                    REQUIRE(scene->distanceToSurface(r.position) < 1e-6);
                    // The same ray again: the first opaque surface is not before the return.
                    HitList hits;
                    scene->castRay(pulse.ray, 1e4, hits);
                    const Hit& last = hits.hits[hits.size - 1];
                    REQUIRE(r.range <= last.distance + 1e-9);
                    ++opaque;
                }
            }
        }
        CHECK(opaque > 1000);
    }
}

TEST_CASE("range noise has the deviation asked for, along the beam") {
    auto scene = Scene::make(SceneKind::indoor, 5, 0);
    Scanner scanner(*scene, 5, 0.02);
    Source source = planSources(*scene).front();
    planPulses(source, 20'000);
    std::vector<Return> returns;
    double sum = 0, squares = 0;
    std::size_t count = 0;
    for (std::uint64_t index = 0; index < source.pulses(); ++index) {
        Pulse pulse = pulseOf(source, 5, index);
        scanner.measure(source, index, pulse, returns);
        for (const Return& r : returns) {
            Vec3d exact = pulse.ray.origin + pulse.ray.direction * r.range, off = r.position - exact;
            double along = dot(off, pulse.ray.direction);
            REQUIRE(length(off - pulse.ray.direction * along) < 1e-9);
            sum += along;
            squares += along * along;
            ++count;
        }
    }
    double n = static_cast<double>(count);
    CHECK(std::abs(sum / n) < 0.001);
    CHECK(std::sqrt(squares / n) == Approx(0.02).epsilon(0.05));
}

TEST_CASE("returns of a pulse are adjacent, numbered by range, and share what belongs to the pulse") {
    for (SceneKind kind : allKinds) {
        Scan scan = scanOf(kind, 60'000);
        ScanColumns c(scanSchema());
        int expected = 1, count = 0;
        double time = -1;
        std::size_t several = 0;
        eachPoint(scan, [&](const PointBatch& batch, std::size_t i) {
            int number = batch.value<std::uint8_t>(c.returnNumber, i);
            REQUIRE(number == expected);
            if (number == 1) {
                count = batch.value<std::uint8_t>(c.numberOfReturns, i);
                time = batch.value<double>(c.gpsTime, i);
                several += count > 1;
            }
            REQUIRE(batch.value<std::uint8_t>(c.numberOfReturns, i) == count);
            REQUIRE(batch.value<double>(c.gpsTime, i) == time);
            expected = number == count ? 1 : number + 1;
        });
        CHECK(expected == 1);
        CHECK(several > 5);
    }
}

TEST_CASE("later returns are further away, and only what lets a beam by gives more than one") {
    for (SceneKind kind : allKinds) {
        auto scene = Scene::make(kind, 8, 300);
        Scanner scanner(*scene, 8, 0);
        std::vector<Return> returns;
        for (Source source : planSources(*scene)) {
            planPulses(source, 3000);
            for (std::uint64_t index = 0; index < source.pulses(); ++index) {
                Pulse pulse = pulseOf(source, 8, index);
                scanner.measure(source, index, pulse, returns);
                for (std::size_t i = 1; i < returns.size(); ++i)
                    REQUIRE(returns[i].range > returns[i - 1].range + source.minSeparation - 1e-9);
                for (std::size_t i = 0; i + 1 < returns.size(); ++i) {
                    auto k = returns[i].classification;
                    bool passes = (k >= classes::lowVegetation && k <= classes::highVegetation) ||
                                  (k >= classes::guardWire && k <= classes::tower);
                    REQUIRE(passes);
                }
            }
        }
    }
}

TEST_CASE("normals are of length 1, towards the scanner, and change nothing else") {
    SynthOptions options;
    options.points = 20'000;
    options.seed = 5;
    Scan without = scanOf(options);
    options.normals = true;
    Scan with = scanOf(options);
    ScanColumns c(scanSchema(true));
    CHECK(ScanColumns(scanSchema()).normal == std::array{-1, -1, -1});
    REQUIRE(with.batches.size() == without.batches.size());
    std::size_t roads = 0, level = 0;
    for (std::size_t b = 0; b < with.batches.size(); ++b) {
        const PointBatch& batch = with.batches[b];
        REQUIRE(batch.positions == without.batches[b].positions);
        for (std::size_t column = 0; column < without.batches[b].columns.size(); ++column)
            REQUIRE(batch.columns[column] == without.batches[b].columns[column]);
        for (std::size_t i = 0; i < batch.size(); ++i) {
            Vec3d n;
            for (int axis = 0; axis < 3; ++axis)
                n[axis] = double{batch.value<float>(c.normal[static_cast<std::size_t>(axis)], i)};
            REQUIRE(std::abs(length(n) - 1) < 1e-6);
            if (batch.value<std::uint8_t>(c.classification, i) == classes::road) { // seen from above
                ++roads;
                level += n.z > 0.9;
            }
        }
    }
    CHECK(roads > 100);
    CHECK(level == roads);
}

TEST_CASE("time runs on, and strips and stations have numbers of their own") {
    Scan scan = scanOf(SceneKind::town, 50'000);
    ScanColumns c(scanSchema());
    double before = 0;
    std::set<int> sources;
    eachPoint(scan, [&](const PointBatch& batch, std::size_t i) {
        double time = batch.value<double>(c.gpsTime, i);
        REQUIRE(time >= before);
        before = time;
        sources.insert(batch.value<std::uint16_t>(c.source, i));
        REQUIRE(std::abs(batch.value<std::int16_t>(c.scanAngle, i)) <= 15'000); // LAS: ±90°
    });
    CHECK(sources.size() == scan.report.strips + scan.report.stations);
}

TEST_CASE("the classes that make each scene are there") {
    auto classesOf = [](const Scan& scan) {
        ScanColumns c(scanSchema());
        std::map<int, std::size_t> count;
        eachPoint(scan, [&](const PointBatch& batch, std::size_t i) {
            ++count[batch.value<std::uint8_t>(c.classification, i)];
        });
        return count;
    };
    namespace k = classes;
    auto town = classesOf(scanOf(SceneKind::town, 200'000));
    for (int code : {+k::ground, +k::lowVegetation, +k::mediumVegetation, +k::highVegetation, +k::building,
                     +k::water, +k::road, +k::conductor, +k::tower, +k::bridge, +k::vehicle})
        CHECK(town[code] > 0);
    auto indoor = classesOf(scanOf(SceneKind::indoor, 100'000));
    for (int code :
         {+k::building, +k::floor, +k::ceiling, +k::stairs, +k::door, +k::window, +k::furniture, +k::lamp})
        CHECK(indoor[code] > 0);
    auto terrain = classesOf(scanOf(SceneKind::terrain, 200'000));
    for (int code : {+k::ground, +k::highVegetation, +k::water, +k::road, +k::conductor, +k::tower})
        CHECK(terrain[code] > 0);
}

TEST_CASE("colours are eight bits times 257") {
    Scan scan = scanOf(SceneKind::town, 20'000, 0.01);
    ScanColumns c(scanSchema());
    std::set<int> reds;
    eachPoint(scan, [&](const PointBatch& batch, std::size_t i) {
        for (int column : {c.red, c.green, c.blue})
            REQUIRE(batch.value<std::uint16_t>(column, i) % 257 == 0);
        reds.insert(batch.value<std::uint16_t>(c.red, i));
    });
    CHECK(reds.size() > 100);
}
