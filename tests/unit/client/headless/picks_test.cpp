// Picking in real clouds against looking at every point: what a session's picture shows under the pointer, in
// the reference renderer's arithmetic; and all that the file says of the points found, against the scan.
#include "client/core/point_query.hpp"
#include "client/core/view_session.hpp"
#include "client/headless/session_loader.hpp"
#include "client/headless/thread_decoder.hpp"
#include "client/render/software_renderer.hpp"
#include "converter/build/convert.hpp"
#include "shared/io/file_source.hpp"
#include "tests/support/data.hpp"
#include "tests/support/reference_picture.hpp"
#include "tests/support/temporary_folder.hpp"

#include <algorithm>
#include <chrono>

using namespace stipple;
using namespace stipple::test;

namespace {

struct OpenCloud {
    TemporaryFolder folder;
    std::unique_ptr<NodeDecoder> decoder = makeThreadDecoder(2);
    std::unique_ptr<ViewSession> session;
    std::shared_ptr<const CloudMetadata> metadata;

    explicit OpenCloud(const std::string& scan, std::uint64_t budget) {
        std::string path = folder.path() + "/c.stipple";
        auto converted =
            convertFiles({scan}, path, {}, [](const std::string&, std::uint64_t, std::uint64_t) {});
        REQUIRE(converted.ok());
        auto source = openFileSource(path);
        REQUIRE(source.ok());
        SessionLimits limits;
        limits.pointBudget = budget;
        session = ViewSession::create(*decoder, limits);
        session->addCloud(std::move(*source), path);
        settle([&] { return session->clouds()[0].stage == CloudStage::ready; });
        metadata = session->clouds()[0].metadata;
    }

    void settle(const std::function<bool()>& done) {
        headless::SessionLoader loader(*session, "cloud", std::chrono::seconds(60));
        REQUIRE(loader.until(done).ok());
    }

    const FramePlan& look(Projection projection) {
        session->setViewport(640, 480);
        session->setCamera(namedCamera(NamedView::iso, session->contentBounds(), 640.0 / 480, projection));
        session->update();
        settle([&] { return session->settled(); });
        return session->plan();
    }

    // The plan's points as the reference takes them, each node's with its own first order.
    std::vector<PointBatch> batchesOf(const FramePlan& plan) const {
        std::vector<PointBatch> batches;
        for (const DrawNode& node : plan.nodes) {
            PointBatch batch;
            for (std::uint32_t i = 0; i < node.pointCount; ++i)
                batch.positions.push_back(positionRecord(*metadata, *node.node, i).integers);
            batches.push_back(std::move(batch));
        }
        return batches;
    }
};

ReferencePoints referenceOf(const OpenCloud& cloud, const FramePlan& plan) {
    std::vector<PointBatch> batches = cloud.batchesOf(plan);
    std::vector<reference::Points> points;
    std::uint64_t order = 0;
    for (const PointBatch& batch : batches) {
        reference::Points node;
        node.grid = &cloud.metadata->grid;
        node.batch = &batch;
        node.firstOrder = order;
        points.push_back(std::move(node));
        order += batch.size();
    }
    REQUIRE(order < (1u << 24));
    reference::View view =
        reference::viewOf(cloud.session->camera(), plan.width, plan.height, cloud.session->contentBounds());
    view.near = plan.view.near;
    view.far = plan.view.far;
    return referencePoints(view, plan.style, points);
}

// Anywhere, and every other time near a pixel that shows a point.
PickRequest someRequest(const ReferencePoints& points, TestRandom& random) {
    auto pixels = static_cast<std::uint32_t>(points.order.size());
    auto radius = static_cast<int>(random.below(9));
    if (random.below(2) == 0)
        return {random.unit() * points.width, random.unit() * points.height, radius};
    std::uint32_t at = random.below(pixels);
    while (points.order[at] == 0)
        at = (at + 1) % pixels;
    auto width = static_cast<std::uint32_t>(points.width);
    return {at % width + 10 * random.unit() - 4.5, at / width + 10 * random.unit() - 4.5, radius};
}

struct Tally {
    int picks = 0, hits = 0, equal = 0, wrong = 0; // wrong: not equal, and the reference is sure
    std::vector<double> milliseconds;
};

void pickAround(OpenCloud& cloud, Projection projection, int count, std::uint64_t seed, Tally& tally) {
    const FramePlan& plan = cloud.look(projection);
    ReferencePoints reference = referenceOf(cloud, plan);
    auto renderer = SoftwareRenderer::create(1);
    TestRandom random(seed);
    for (int i = 0; i < count; ++i) {
        PickRequest request = someRequest(reference, random);
        ExpectedPick expected = expectedPick(reference, request);
        auto start = std::chrono::steady_clock::now();
        std::optional<PickHit> hit = renderer->pick(plan, request);
        std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
        bool equal = orderOf(hit, plan) == expected.order;
        ++tally.picks;
        tally.hits += hit.has_value();
        tally.equal += equal;
        tally.wrong += !equal && expected.isSure;
        tally.milliseconds.push_back(took.count());
    }
}

void pickInScans(int perView, std::uint64_t budget) {
    Tally tally;
    for (const char* scan : {"clouds/lion_takanawa.copc.laz", "clouds/lone-star.laz", "clouds/indoor.laz"}) {
        OpenCloud cloud(dataPath(scan), budget);
        for (Projection projection : {Projection::perspective, Projection::orthographic})
            pickAround(cloud, projection, perView, 3, tally);
    }
    std::sort(tally.milliseconds.begin(), tally.milliseconds.end());
    WARN(tally.picks << " picks, " << tally.hits << " hits, " << tally.equal << " equal to brute force, "
                     << tally.wrong << " wrong where that is sure; "
                     << tally.milliseconds[tally.milliseconds.size() / 2] << " ms in the middle, "
                     << tally.milliseconds.back() << " at most");
    CHECK(tally.wrong == 0);
    CHECK(tally.equal > 0.95 * tally.picks); // so the reference is sure nearly everywhere
    CHECK(tally.hits > tally.picks / 3);
}

} // namespace

TEST_CASE("picks in real clouds are those of brute force", "[picks]") {
    STIPPLE_NEEDS_DATA();
    pickInScans(60, 200'000);
}

TEST_CASE("ten thousand picks in real clouds are those of brute force", "[picks][slow]") {
    STIPPLE_NEEDS_DATA();
    pickInScans(1'667, 2'000'000);
}
