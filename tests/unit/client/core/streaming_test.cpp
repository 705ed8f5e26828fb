// Sessions over a simulated network, on its virtual clock.
#include "client/core/load_queue.hpp"
#include "client/core/view_session.hpp"

#include "tests/support/simulated_network.hpp"
#include "tests/support/small_cloud.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <set>

using namespace stipple;
using namespace stipple::test;
using namespace std::chrono_literals;

namespace {

NetworkOptions network(double megabits, std::chrono::nanoseconds roundTrip) {
    NetworkOptions options;
    options.megabitsPerSecond = megabits;
    options.roundTrip = roundTrip;
    return options;
}

// 21 nodes, some 3 MB.
const SmallCloud& bigCloud() {
    static SmallCloud cloud = makeSmallCloud({.levels = 3, .pointsPerNode = 20000});
    return cloud;
}
// 341 nodes in a file of 10 MB.
const SmallCloud& wideCloud() {
    static SmallCloud cloud = makeSmallCloud({.levels = 5, .pointsPerNode = 4000});
    return cloud;
}

struct Viewer {
    SimulatedNetwork net;
    std::shared_ptr<HostedFile> file = std::make_shared<HostedFile>();
    const SmallCloud& cloud;
    std::unique_ptr<NodeDecoder> decoder = makeInlineDecoder();
    std::unique_ptr<ViewSession> session;

    explicit Viewer(const SmallCloud& shown, const NetworkOptions& options = {}, SessionLimits limits = {})
        : net(options), cloud(shown) {
        limits.minNodePixels = 1;
        session = ViewSession::create(*decoder, limits, [this] { return net.now(); });
        session->setViewport(800, 600);
        session->setCamera(overview());
        file->bytes = cloud.file;
        session->addCloud(net.open(file, "http://host/cloud.stipple"), "cloud");
    }

    Camera overview() const { return namedCamera(NamedView::top, cloud.metadata.worldBounds(), 800.0 / 600); }
    // Near the ground, at a place of the cloud by parts of its sides.
    Camera near(double x, double y, double part = 0.05) const {
        BoxD box = cloud.metadata.worldBounds();
        Vec3d size = box.max - box.min;
        Camera camera;
        camera.target = box.min + Vec3d{x * size.x, y * size.y, 0.5 * size.z};
        camera.position = camera.target + Vec3d{0, -0.3, 1} * (part * length(size));
        return camera;
    }

    // Goes on for so long, or until settled.
    bool run(SimulatedNetwork::Duration most = 10min) {
        auto end = net.now() + most;
        session->update();
        while (!session->settled() && net.now() < end) {
            net.advance(std::min<SimulatedNetwork::Duration>(16ms, end - net.now()));
            session->update();
        }
        return session->settled();
    }
    double seconds() const { return std::chrono::duration<double>(net.now().time_since_epoch()).count(); }
    std::uint64_t pointsDrawn() const { return session->plan().counters.pointsDrawn; }
    SessionCounters counters() const { return session->counters(); }
    CloudState state() const { return session->clouds().front(); }
};

} // namespace

TEST_CASE("the same flight over the same network asks for the same bytes at the same times") {
    auto fly = [] {
        Viewer viewer(wideCloud(), network(20, 40ms));
        std::vector<double> track;
        for (int i = 0; i < 60; ++i) {
            viewer.session->setCamera(
                viewer.near(0.5 + 0.4 * std::sin(i * 0.9), 0.5 + 0.4 * std::cos(i * 1.3)));
            viewer.run(100ms);
            track.push_back(viewer.seconds());
            track.push_back(static_cast<double>(viewer.counters().bytesReceived));
            track.push_back(static_cast<double>(viewer.counters().requests));
        }
        return track;
    };
    CHECK(fly() == fly());
}

TEST_CASE("a wild flight fetches no byte twice, and a return to what was seen asks for nothing") {
    auto options = GENERATE(network(5, 200ms), network(50, 50ms), network(500, 200ms));
    Viewer viewer(wideCloud(), options);
    for (int i = 0; i < 200; ++i) {
        viewer.session->setCamera(viewer.near(0.5 + 0.45 * std::sin(i * 0.7), 0.5 + 0.45 * std::cos(i * 1.1),
                                              0.03 + 0.1 * (i % 7)));
        viewer.run(50ms);
    }
    REQUIRE(viewer.run());
    Camera last = viewer.session->camera();
    CHECK(viewer.counters().bytesFetchedTwice == 0);
    CHECK(viewer.counters().requestsFailed == 0);
    viewer.session->setCamera(viewer.near(0.1, 0.9));
    REQUIRE(viewer.run());
    std::uint64_t requests = viewer.net.counters().requests;
    viewer.session->setCamera(last);
    REQUIRE(viewer.run());
    viewer.session->setCamera(viewer.near(0.1, 0.9));
    REQUIRE(viewer.run());
    CHECK(viewer.net.counters().requests == requests);
    CHECK(viewer.counters().bytesFetchedTwice == 0);
}

TEST_CASE(
    "what is nearly here when it is no longer wanted is let finish, the rest is cancelled; both count") {
    Viewer viewer(bigCloud(), network(5, 10ms));
    for (int i = 0; i < 300; ++i) {
        viewer.session->setCamera(
            viewer.near(0.5 + 0.45 * std::sin(i * 2.1), 0.5 + 0.45 * std::cos(i * 1.7)));
        viewer.run(40ms);
    }
    SessionCounters counters = viewer.counters();
    CHECK(counters.requestsCancelled > 0);
    CHECK(counters.requestsLetFinish > 0);
    CHECK(counters.bytesWasted > 0);
    // The network's own count has what came of headers and after the cancelling, too.
    CHECK(counters.bytesWasted <= viewer.net.counters().bytesWasted);
}

TEST_CASE("the pipe is full where much fits into it, and requests are short where little does") {
    SECTION("500 Mbit/s, 200 ms: in a third of the time that fixed limits take") {
        Viewer viewer(wideCloud(), network(500, 200ms));
        REQUIRE(viewer.run());
        CHECK(viewer.pointsDrawn() == wideCloud().metadata.pointCount);
        SessionLimits limits;
        limits.techniques.adaptive = false;
        Viewer fixed(wideCloud(), network(500, 200ms), limits);
        REQUIRE(fixed.run());
        CHECK(viewer.seconds() < fixed.seconds() / 3);
        CHECK(viewer.net.counters().bytesCarried < 2 * fixed.net.counters().bytesCarried);
    }
    SECTION("5 Mbit/s, 5 ms: a new view begins to come within a third of a second") {
        Viewer viewer(wideCloud(), network(5, 5ms));
        viewer.run(2s);
        REQUIRE_FALSE(viewer.session->settled());
        viewer.session->setCamera(viewer.near(0.9, 0.1));
        viewer.session->update();
        std::uint64_t drawn = viewer.pointsDrawn();
        viewer.run(333ms);
        CHECK(viewer.pointsDrawn() > drawn);
        CHECK(viewer.counters().networkBytesPerSecond == Approx(625'000).epsilon(0.2));
        CHECK(viewer.counters().networkDelaySeconds < 0.03);
    }
}

TEST_CASE("a server that asks for a pause is left alone for so long") {
    int status = GENERATE(429, 503);
    Viewer viewer(bigCloud());
    std::uint64_t busyUntil = 4;
    std::vector<double> arrivals;
    viewer.net.fault = [&](std::uint64_t number, ByteRange) -> std::optional<Fault> {
        arrivals.push_back(viewer.seconds());
        if (number == 1 || number > busyUntil)
            return std::nullopt;
        return Fault{Fault::Kind::status, 0, status, "7"};
    };
    REQUIRE(viewer.run());
    CHECK(viewer.pointsDrawn() == bigCloud().metadata.pointCount);
    CHECK(viewer.session->recentErrors().empty());
    CHECK(viewer.counters().requestsRetried > 0);
    std::size_t pauses = 0;
    for (std::size_t i = 1; i < arrivals.size(); ++i)
        pauses += arrivals[i] - arrivals[i - 1] > 6.9;
    CHECK(pauses == 1);
}

TEST_CASE("connections that break now and then cost time, but no point") {
    Viewer viewer(wideCloud(), network(50, 50ms));
    viewer.net.fault = [](std::uint64_t number, ByteRange) -> std::optional<Fault> {
        return number % 5 == 0 ? std::optional(Fault{Fault::Kind::reset, 0.3}) : std::nullopt;
    };
    REQUIRE(viewer.run());
    CHECK(viewer.pointsDrawn() == wideCloud().metadata.pointCount);
    CHECK(viewer.session->recentErrors().empty());
    CHECK(viewer.counters().requestsFailed > 0);
}

TEST_CASE("a network that is gone interrupts the cloud visibly, and retry goes on where it stopped") {
    Viewer viewer(bigCloud(), network(5, 50ms));
    viewer.run(1s);
    REQUIRE(viewer.pointsDrawn() > 0);
    REQUIRE_FALSE(viewer.session->settled());
    bool isGone = true;
    std::uint64_t refused = 0;
    viewer.net.fault = [&](std::uint64_t, ByteRange) -> std::optional<Fault> {
        refused += isGone;
        return isGone ? std::optional(Fault{Fault::Kind::reset, 0}) : std::nullopt;
    };
    REQUIRE(viewer.run());
    CHECK(viewer.state().stage == CloudStage::ready);
    REQUIRE(viewer.state().interrupted);
    CHECK(viewer.state().interrupted->code == ErrorCode::networkFailed);
    CHECK(viewer.state().interrupted->sentence().find("http://host/cloud.stipple") != std::string::npos);
    CHECK(viewer.session->recentErrors().size() == 1);
    std::uint64_t drawn = viewer.pointsDrawn();
    CHECK(drawn > 0);                                   // what is here stays
    CHECK(refused <= 6 * (LoadQueue::maxAttempts + 1)); // with those on their way
    // Nothing more is asked, also when the camera moves.
    std::uint64_t requests = viewer.net.counters().requests;
    viewer.session->setCamera(viewer.near(0.3, 0.3));
    viewer.run(1min);
    CHECK(viewer.net.counters().requests == requests);

    isGone = false;
    viewer.session->setCamera(viewer.overview());
    viewer.session->retry();
    REQUIRE(viewer.run());
    CHECK_FALSE(viewer.state().interrupted);
    CHECK(viewer.pointsDrawn() == bigCloud().metadata.pointCount);
    CHECK(viewer.counters().bytesFetchedTwice == 0);
}

TEST_CASE("a cloud that could not be opened is opened by retry") {
    Viewer viewer(bigCloud());
    bool isGone = true;
    viewer.net.fault = [&](std::uint64_t, ByteRange) -> std::optional<Fault> {
        return isGone ? std::optional(Fault{Fault::Kind::reset, 0}) : std::nullopt;
    };
    REQUIRE(viewer.run());
    CHECK(viewer.state().stage == CloudStage::failed);
    CHECK(viewer.net.counters().requests == LoadQueue::maxAttempts);
    isGone = false;
    viewer.session->retry();
    REQUIRE(viewer.run());
    CHECK(viewer.state().stage == CloudStage::ready);
    CHECK(viewer.pointsDrawn() == bigCloud().metadata.pointCount);
}

TEST_CASE("who may not read is told so after one request, and may try again with what was missing") {
    int status = GENERATE(401, 403);
    bool fromTheStart = GENERATE(true, false);
    Viewer viewer(bigCloud(), network(5, 50ms));
    bool isRefused = true;
    viewer.net.fault = [&](std::uint64_t number, ByteRange) -> std::optional<Fault> {
        bool refuses = isRefused && (fromTheStart || number > 3);
        return refuses ? std::optional(Fault{Fault::Kind::status, 0, status, ""}) : std::nullopt;
    };
    REQUIRE(viewer.run());
    Error error = fromTheStart ? viewer.state().error : viewer.state().interrupted.value_or(Error{});
    CHECK(error.code == ErrorCode::accessDenied);
    CHECK(error.sentence().find(std::to_string(status)) != std::string::npos);
    CHECK_FALSE(error.advice.empty());
    if (fromTheStart)
        CHECK(viewer.net.counters().requests == 1);
    else
        CHECK(viewer.pointsDrawn() > 0);
    isRefused = false;
    viewer.session->retry();
    REQUIRE(viewer.run());
    CHECK(viewer.pointsDrawn() == bigCloud().metadata.pointCount);
}

TEST_CASE("a server without ranges is left after its first answer, with how to mend it") {
    bool fromTheStart = GENERATE(true, false);
    Viewer viewer(bigCloud(), network(5, 50ms));
    std::uint64_t whole = 0;
    viewer.net.fault = [&](std::uint64_t number, ByteRange) -> std::optional<Fault> {
        if (number < (fromTheStart ? 1u : 4u))
            return std::nullopt;
        ++whole;
        return Fault{Fault::Kind::wholeFile};
    };
    REQUIRE(viewer.run());
    CHECK(viewer.state().stage == (fromTheStart ? CloudStage::failed : CloudStage::ready));
    Error error = fromTheStart ? viewer.state().error : viewer.state().interrupted.value_or(Error{});
    CHECK(error.code == ErrorCode::unsupported);
    CHECK(error.sentence().find("ignores Range") != std::string::npos);
    CHECK(error.advice.find("stipple serve") != std::string::npos);
    CHECK(whole <= 6); // those that were on their way
    CHECK(viewer.net.counters().bytesCarried < bigCloud().file.size() / 2);
    CHECK((viewer.pointsDrawn() > 0) != fromTheStart); // what is here stays
    viewer.net.fault = nullptr;
    viewer.session->retry();
    REQUIRE(viewer.run());
    CHECK(viewer.pointsDrawn() == bigCloud().metadata.pointCount);
}

TEST_CASE("a file that is replaced is loaded again, once, and the camera stays") {
    Viewer viewer(bigCloud(), network(50, 50ms));
    viewer.run(400ms);
    REQUIRE_FALSE(viewer.session->settled());
    Camera camera = viewer.session->camera();
    viewer.file->etag = "\"2\"";
    viewer.file->bytes = makeSmallCloud({.levels = 2, .pointsPerNode = 30000, .seed = 9}).file;
    REQUIRE(viewer.run());
    INFO(viewer.state().error.sentence());
    CHECK(viewer.state().stage == CloudStage::ready);
    CHECK(viewer.pointsDrawn() == 5 * 30000);
    CHECK(viewer.session->camera() == camera);
    CHECK(viewer.counters().cloudsReloaded == 1);
    CHECK(viewer.state().reloads == 1);
    CHECK(viewer.session->recentErrors().empty());

    // One that changes with each request is given up.
    std::uint64_t version = 2;
    viewer.net.fault = [&](std::uint64_t, ByteRange) -> std::optional<Fault> {
        viewer.file->etag = "\"" + std::to_string(++version) + "\"";
        return std::nullopt;
    };
    viewer.session->removeCloud(viewer.state().id);
    viewer.file->bytes = bigCloud().file;
    viewer.session->addCloud(viewer.net.open(viewer.file, "http://host/cloud.stipple"), "cloud");
    REQUIRE(viewer.run());
    CHECK(viewer.state().stage == CloudStage::failed);
    CHECK(viewer.state().error.code == ErrorCode::changed);
    CHECK(viewer.counters().cloudsReloaded == 2);
    // Until somebody asks for it, when it stays the same.
    viewer.net.fault = nullptr;
    viewer.session->retry();
    REQUIRE(viewer.run());
    CHECK(viewer.state().stage == CloudStage::ready);
    CHECK(viewer.pointsDrawn() == bigCloud().metadata.pointCount);
}

TEST_CASE("what is tried again is told, with the time until then") {
    Viewer viewer(bigCloud(), network(50, 50ms));
    viewer.net.fault = [](std::uint64_t number, ByteRange) -> std::optional<Fault> {
        return number == 1 ? std::optional(Fault{Fault::Kind::status, 0, 503, "5"}) : std::nullopt;
    };
    CHECK_FALSE(viewer.state().retrying);
    viewer.run(1s);
    REQUIRE(viewer.state().retrying);
    CHECK(viewer.state().retrying->sentence().find("http://host/cloud.stipple: the server is busy") == 0);
    CHECK(viewer.state().retrySeconds > 3);
    CHECK(viewer.state().retrySeconds < 5);
    REQUIRE(viewer.run());
    CHECK_FALSE(viewer.state().retrying);
    CHECK(viewer.pointsDrawn() == bigCloud().metadata.pointCount);
}

TEST_CASE("one cloud of two is tried again where only it is meant") {
    Viewer viewer(bigCloud());
    viewer.session->addCloud(viewer.net.open(viewer.file, "http://host/other.stipple"), "other");
    viewer.net.fault = [](std::uint64_t, ByteRange) {
        return std::optional(Fault{Fault::Kind::status, 0, 401, ""});
    };
    REQUIRE(viewer.run());
    viewer.net.fault = nullptr;
    viewer.session->retry(viewer.state().id);
    REQUIRE(viewer.run());
    CHECK(viewer.session->clouds().front().stage == CloudStage::ready);
    CHECK(viewer.session->clouds().back().stage == CloudStage::failed);
}

TEST_CASE("a node that stays damaged is counted as missing, and asked for anew by retry") {
    Viewer viewer(bigCloud(), network(50, 50ms));
    std::uint64_t at = bigCloud().file.size() * 6 / 10;
    viewer.net.fault = [&](std::uint64_t, ByteRange range) -> std::optional<Fault> {
        if (at < range.offset || at >= range.end())
            return std::nullopt;
        double part = static_cast<double>(at - range.offset) / static_cast<double>(range.size);
        return Fault{Fault::Kind::corruptBody, part};
    };
    REQUIRE(viewer.run());
    CHECK(viewer.state().stage == CloudStage::ready);
    CHECK(viewer.state().nodesMissing == 1);
    CHECK(viewer.state().chunksMissing == 0);
    REQUIRE(viewer.state().lastLoss);
    CHECK(viewer.state().lastLoss->code == ErrorCode::corrupt);
    CHECK(viewer.pointsDrawn() >= bigCloud().metadata.pointCount - 20000);
    CHECK(viewer.pointsDrawn() < bigCloud().metadata.pointCount);
    viewer.net.fault = nullptr;
    viewer.session->retry();
    REQUIRE(viewer.run());
    CHECK(viewer.state().nodesMissing == 0);
    CHECK_FALSE(viewer.state().lastLoss);
    CHECK(viewer.pointsDrawn() == bigCloud().metadata.pointCount);
}

TEST_CASE("decoded nodes that had to go are decoded again from the bytes they came as, within both limits") {
    SessionLimits limits;
    limits.cacheBytes = 1'500'000; // of some 5 MB
    Viewer viewer(wideCloud(), network(50, 20ms), limits);
    std::vector<Camera> places;
    for (int i = 0; i < 6; ++i)
        places.push_back(viewer.near(0.5 + 0.4 * std::sin(i), 0.5 + 0.4 * std::cos(i)));
    for (const Camera& place : places) {
        viewer.session->setCamera(place);
        REQUIRE(viewer.run());
    }
    CHECK(viewer.counters().nodesEvicted > 0);
    CHECK(viewer.counters().cacheBytes <= limits.cacheBytes + 50'000); // and what nodes take beside points
    std::uint64_t requests = viewer.net.counters().requests, decoded = viewer.counters().nodesDecoded;
    std::uint64_t reused = viewer.counters().bytesReused;
    for (const Camera& place : places) {
        viewer.session->setCamera(place);
        REQUIRE(viewer.run());
    }
    CHECK(viewer.net.counters().requests == requests);
    CHECK(viewer.counters().nodesDecoded > decoded);
    CHECK(viewer.counters().bytesReused > reused);
    CHECK(viewer.counters().bytesFetchedTwice == 0);

    SECTION("less room for them is kept, too, and costs requests") {
        limits.compressedBytes = 300'000;
        viewer.session->setLimits(limits);
        REQUIRE(viewer.run());
        CHECK(viewer.counters().compressedBytes <=
              limits.compressedBytes + 100'000); // and what opened the cloud
        for (const Camera& place : places) {
            viewer.session->setCamera(place);
            REQUIRE(viewer.run());
        }
        CHECK(viewer.net.counters().requests > requests);
        CHECK(viewer.counters().compressedBytes <= limits.compressedBytes + 100'000);
        CHECK(viewer.session->recentErrors().empty());
    }
    SECTION("with none at all every picture still comes, whole") {
        limits.compressedBytes = 0;
        viewer.session->setLimits(limits);
        for (const Camera& place : places) {
            viewer.session->setCamera(place);
            REQUIRE(viewer.run());
            CHECK(viewer.session->plan().counters.complete);
        }
        CHECK(viewer.session->recentErrors().empty());
    }
    SECTION("a closed cloud gives all of it back") {
        viewer.session->removeCloud(viewer.state().id);
        viewer.run();
        CHECK(viewer.counters().cacheBytes == 0);
        CHECK(viewer.counters().compressedBytes == 0);
        CHECK(viewer.session->plan().nodes.empty());
    }
}

TEST_CASE("attributes that nothing uses any more are let go after a while, and come back without a request") {
    Viewer viewer(bigCloud());
    REQUIRE(viewer.run());
    Style byIntensity;
    byIntensity.colourMode = ColourMode::intensity;
    viewer.session->setStyle(byIntensity);
    REQUIRE(viewer.run());
    std::uint64_t with = viewer.counters().cacheBytes, requests = viewer.net.counters().requests;
    viewer.session->setStyle({});
    REQUIRE(viewer.run());
    CHECK(viewer.counters().columnsDropped == 0);
    viewer.net.advance(29s);
    viewer.session->update();
    CHECK(viewer.counters().columnsDropped == 0);
    viewer.net.advance(2s);
    viewer.session->update();
    CHECK(viewer.counters().columnsDropped == bigCloud().nodes.size());
    CHECK(viewer.counters().cacheBytes <= with - 2 * bigCloud().metadata.pointCount);
    viewer.session->setStyle(byIntensity);
    REQUIRE(viewer.run());
    CHECK(viewer.pointsDrawn() == bigCloud().metadata.pointCount);
    CHECK(viewer.net.counters().requests == requests);
}

TEST_CASE("a frame brings no more that is new than its limit, and the next ones the rest") {
    Viewer viewer(bigCloud());
    REQUIRE(viewer.run());
    Camera away = viewer.overview();
    away.target = away.position + Vec3d{0, 0, 1000};
    viewer.session->setCamera(away);
    REQUIRE(viewer.run());
    REQUIRE(viewer.pointsDrawn() == 0);
    SessionLimits limits = viewer.session->limits();
    limits.uploadBytes = 600'000; // two nodes of 20,000 points
    viewer.session->setLimits(limits);
    viewer.session->setCamera(viewer.overview());
    std::set<std::uint64_t> shown;
    std::uint64_t frames = 0, most = 0, delayed = 0;
    auto look = [&] {
        std::uint64_t bytes = 0;
        for (const DrawNode& node : viewer.session->plan().nodes)
            if (shown.insert(node.node->id).second)
                bytes += 12 * std::uint64_t{node.node->pointCount};
        most = std::max(most, bytes);
        delayed += viewer.session->plan().counters.nodesDelayed;
        ++frames;
    };
    for (int i = 0; i < 100 && !viewer.session->settled(); ++i)
        if (viewer.session->update())
            look();
    REQUIRE(viewer.session->settled());
    CHECK(viewer.pointsDrawn() == bigCloud().metadata.pointCount);
    CHECK(viewer.session->plan().counters.complete);
    CHECK(delayed > 0);
    CHECK(most <= limits.uploadBytes);
    CHECK(frames == 11); // for 21 nodes
    CHECK_FALSE(viewer.session->update());
}

TEST_CASE(
    "bytes that are damaged on their way are fetched once more; a damaged node is marked, the rest shown") {
    Viewer viewer(bigCloud(), network(50, 50ms));
    viewer.net.fault = [](std::uint64_t number, ByteRange) -> std::optional<Fault> {
        return number == 4 || number == 7 ? std::optional(Fault{Fault::Kind::corruptBody}) : std::nullopt;
    };
    REQUIRE(viewer.run());
    CHECK(viewer.session->recentErrors().empty());
    CHECK(viewer.pointsDrawn() == bigCloud().metadata.pointCount);
    CHECK(viewer.counters().bytesFetchedTwice > 0);
}
