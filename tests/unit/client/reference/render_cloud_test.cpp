#include "client/reference/finest_nodes.hpp"
#include "client/reference/leaf_densities.hpp"
#include "client/reference/render_cloud.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/memory_source.hpp"
#include "tests/support/small_cloud.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace stipple;
using namespace stipple::test;
using reference::Job;
using reference::renderCloud;

namespace {

const SmallCloud& cloud() {
    static const SmallCloud made = makeSmallCloud();
    return made;
}

Job job(NamedView view = NamedView::iso, ColourMode mode = ColourMode::rgb, int samples = 1) {
    Job result;
    BoxD content = cloud().metadata.worldBounds();
    result.view = reference::viewOf(namedCamera(view, content, 1.5), 120, 80, content);
    result.style.colourMode = mode;
    result.style.edl.strength = 0.01;
    result.style.intensityRange = {0, 65535};
    result.style.elevationRange = {content.min.z, content.max.z};
    result.samples = samples;
    return result;
}

std::vector<DepthImage> draw(const std::vector<Job>& jobs, const reference::Options& options = {}) {
    MemorySource source(cloud().file);
    auto pictures = renderCloud(source, jobs, options);
    if (!pictures.ok())
        FAIL(pictures.error().sentence());
    return std::move(*pictures);
}

bool same(const DepthImage& a, const DepthImage& b) {
    return a.image.width == b.image.width && a.image.rgba == b.image.rgba && a.distances == b.distances;
}

// The same from points read one node after the other, all of them at once.
DepthImage drawnAtOnce(const Job& of) {
    MemorySource source(cloud().file);
    auto reader = CloudReader::open(source);
    REQUIRE(reader.ok());
    std::vector<reference::Mark> marks;
    std::uint64_t order = 0;
    for (const NodeEntry& entry : cloud().nodes) {
        auto batch = (*reader)->readNode(entry);
        REQUIRE(batch.ok());
        reference::Points points;
        points.grid = &(*reader)->metadata().grid;
        points.batch = &*batch;
        points.attributes = (*reader)->metadata().schema.attributes;
        points.firstOrder = order;
        points.level = entry.key.level;
        points.nodePoints = entry.pointCount;
        // Nodes have four children with as many points as themselves, so a leaf's next point makes it denser
        // by three in 400, as in any other node; had the file but two levels, by four.
        points.leafStep = entry.childMask == 0 ? 4 * 0.75 / 400 : 0;
        order += batch->size();
        appendMarks(of.view, of.style, points, marks);
    }
    reference::Canvas canvas(of.view.width, of.view.height, of.samples);
    canvas.draw(marks, of.style.shape);
    return canvas.finish(of.style);
}

} // namespace

TEST_CASE("a cloud is drawn with every point, in any colour") {
    for (ColourMode mode : {ColourMode::rgb, ColourMode::intensity, ColourMode::elevation}) {
        Job one = job(NamedView::iso, mode);
        DepthImage picture = draw({one})[0];
        CHECK(same(picture, drawnAtOnce(one)));
        CHECK(std::count_if(picture.distances.begin(), picture.distances.end(),
                            [](float d) { return d > 0; }) > 2000);
    }
}

TEST_CASE("with continuous detail the level of a leaf's point follows the density of the level above") {
    Job one = job(NamedView::iso, ColourMode::level);
    one.style.detail.mode = DetailMode::continuous;
    one.style.levelRange = {0, 3};
    CHECK(same(draw({one})[0], drawnAtOnce(one)));

    auto stepsOf = [](const SmallCloud& of) {
        MemorySource source(of.file);
        auto reader = CloudReader::open(source);
        REQUIRE(reader.ok());
        auto densities = reference::LeafDensities::of(**reader);
        REQUIRE(densities.ok());
        std::vector<double> steps;
        for (const NodeEntry& entry : of.nodes)
            steps.push_back(densities->stepOf(entry.key));
        return steps;
    };
    std::vector<double> deep = stepsOf(cloud()), flat = stepsOf(makeSmallCloud({.levels = 2}));
    REQUIRE(deep.size() == 21);
    CHECK(std::count(deep.begin(), deep.begin() + 5, 0) == 5); // the root and its children
    CHECK(std::count(deep.begin() + 5, deep.end(), 4 * 0.75 / 400) == 16);
    CHECK(flat == std::vector<double>{0, 0.01, 0.01, 0.01, 0.01});

    // 400 points on a quarter of what the root's 400 fill.
    Style style = one.style;
    style.gradient = GradientName::grey;
    style.levelRange = {0, 2};
    PointBatch batch;
    batch.positions.resize(400);
    reference::Points leaf;
    leaf.batch = &batch;
    leaf.level = 1;
    leaf.nodePoints = 400;
    leaf.leafStep = 0.01;
    CHECK(coloursOf(style, leaf)[399][0] == Approx(255 * std::log2(1 + 1.5 / 400 + 3.99) / 4).margin(1));
    leaf.leafStep = 0;
    CHECK(coloursOf(style, leaf)[399][0] == Approx(127.5).margin(1));
    leaf.level = 0;
    CHECK(coloursOf(style, leaf)[399][0] == Approx(0).margin(1));
}

TEST_CASE("the spacing where a point lies is that of the finest of all nodes that hold it") {
    MemorySource source(cloud().file);
    auto reader = CloudReader::open(source);
    REQUIRE(reader.ok());
    auto finest = reference::FinestNodes::of(**reader);
    REQUIRE(finest.ok());
    const CloudMetadata& metadata = (*reader)->metadata();
    int inner = 0;
    for (const NodeEntry& entry : cloud().nodes) {
        auto batch = (*reader)->readNode(entry);
        REQUIRE(batch.ok());
        std::vector<double> found = finest->spacingsAt(*batch);
        for (std::size_t i = 0; i < batch->size(); ++i) {
            double least = metadata.spacing;
            for (const NodeEntry& other : cloud().nodes)
                if (metadata.rootCube.keyOf(batch->positions[i], other.key.level) == other.key)
                    least = std::min(least, std::ldexp(metadata.spacing, -other.key.level));
            REQUIRE(found[i] == least);
            inner += least < std::ldexp(metadata.spacing, -entry.key.level);
        }
    }
    CHECK(inner > 0);
}

TEST_CASE("threads, and how many pictures are drawn at a time, change nothing") {
    std::vector<Job> jobs{job(), job(NamedView::top, ColourMode::elevation),
                          job(NamedView::front, ColourMode::rgb, 2),
                          job(NamedView::iso, ColourMode::intensity), job()};
    jobs[4].style.splats.enabled = true;
    std::vector<DepthImage> pictures = draw(jobs, {1, 1ull << 30, {}});
    REQUIRE(pictures.size() == 5);
    CHECK_FALSE(same(pictures[0], pictures[3]));
    CHECK_FALSE(same(pictures[0], pictures[4]));
    for (const reference::Options& options :
         {reference::Options{3, 1ull << 30, {}}, {2, 1, {}}, {2, 600000, {}}}) {
        std::vector<DepthImage> again = draw(jobs, options);
        REQUIRE(again.size() == 5);
        for (std::size_t i = 0; i < 5; ++i)
            CHECK(same(again[i], pictures[i]));
    }
}

TEST_CASE("progress ends with all points of all readings") {
    std::uint64_t last = 0, all = 0;
    reference::Options options{1, 1, [&](std::uint64_t done, std::uint64_t total) {
                                   CHECK(done > last);
                                   last = done;
                                   all = total;
                               }};
    draw({job(), job(NamedView::top)}, options);
    CHECK(last == 2 * cloud().metadata.pointCount);
    CHECK(all == last);
}

TEST_CASE("damaged bytes and pictures without pixels are errors") {
    Job none = job();
    none.view.width = 0;
    MemorySource source(cloud().file);
    CHECK(renderCloud(source, std::vector<Job>{none}).error().code == ErrorCode::invalidArgument);
    none = job();
    none.samples = 0;
    CHECK(renderCloud(source, std::vector<Job>{none}).error().code == ErrorCode::invalidArgument);
    Bytes damaged = cloud().file;
    const NodeEntry& node = cloud().nodes[cloud().nodes.size() / 2];
    damaged[node.offsetBytes + 20] ^= 0x40;
    MemorySource bad(damaged);
    for (int threads : {1, 3}) {
        auto answer = renderCloud(bad, std::vector<Job>{job()}, {threads, 1ull << 30, {}});
        REQUIRE_FALSE(answer.ok());
        CHECK(answer.error().code == ErrorCode::corrupt);
    }
}
