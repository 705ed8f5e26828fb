// ViewSession::load(): what a program does while its next picture is long in coming.
#include "client/core/view_session.hpp"

#include "tests/support/scripted_source.hpp"
#include "tests/support/small_cloud.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::test;

namespace {

struct Between {
    SmallCloud cloud = makeSmallCloud({.levels = 3, .pointsPerNode = 20000});
    std::unique_ptr<NodeDecoder> decoder = makeInlineDecoder();
    std::unique_ptr<ViewSession> session;
    std::shared_ptr<SourceScript> script = std::make_shared<SourceScript>();

    explicit Between(SessionLimits limits = {}) {
        limits.minNodePixels = 1;
        session = ViewSession::create(*decoder, limits);
        session->setViewport(800, 600);
        script->file = cloud.file;
        session->addCloud(std::make_unique<ScriptedSource>(script), "small");
        session->setCamera(namedCamera(NamedView::top, cloud.metadata.worldBounds(), 800.0 / 600));
    }
    void load(int times) {
        for (int i = 0; i < times; ++i)
            session->load();
    }
};

} // namespace

TEST_CASE("between frames all that the picture needs is loaded, and the next frame shows it") {
    Between between;
    between.session->update();
    std::uint64_t before = between.session->plan().counters.pointsDrawn;
    CHECK(before < between.cloud.metadata.pointCount);
    between.load(200);
    CHECK(between.session->counters().nodesDecoded >= between.cloud.nodes.size());
    CHECK(between.session->plan().counters.pointsDrawn == before); // the last picture stands
    CHECK_FALSE(between.session->settled());                       // and is not the last
    CHECK(between.session->update());
    CHECK(between.session->plan().counters.pointsDrawn == between.cloud.metadata.pointCount);
    CHECK(between.session->settled());
}

TEST_CASE("loading between frames paints nothing and counts no frames") {
    Between between;
    between.load(200);
    SessionCounters counters = between.session->counters();
    CHECK(counters.framesDrawn + counters.framesSkipped == 0);
    CHECK(counters.nodesPainted == 0);
    CHECK(counters.bytesReceived > 0);
}

TEST_CASE("however much came between two frames, the next one brings no more than its share to the GPU") {
    SessionLimits limits;
    limits.uploadBytes = 1 << 20;
    Between between(limits);
    between.load(200);
    std::uint64_t shown = 0;
    int frames = 0;
    for (; frames < 100 && !between.session->settled(); ++frames) {
        between.session->update();
        std::uint64_t now = between.session->plan().counters.pointsDrawn;
        CHECK((now - shown) * 12 <= limits.uploadBytes); // two words of position and a colour
        shown = now;
    }
    CHECK(shown == between.cloud.metadata.pointCount);
    CHECK(frames > 2);
}
