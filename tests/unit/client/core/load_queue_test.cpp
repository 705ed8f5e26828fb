#include "client/core/load_queue.hpp"

#include "tests/support/scripted_source.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::test;

namespace {

const LoadQueue::Clock::time_point start{};

LoadItem item(std::uint64_t id, ByteRange range, std::uint32_t cloud = 1) {
    LoadItem made;
    made.key = {cloud, LoadKind::picture, id};
    made.range = range;
    return made;
}

struct Loading {
    SessionCounters counters;
    std::shared_ptr<SourceScript> script = std::make_shared<SourceScript>();
    ScriptedSource source{script};
    LoadQueue queue{counters};
    LoadLimits limits{4, 10'000, 100, 1000};

    Loading() {
        script->file.resize(100'000);
        for (std::size_t i = 0; i < script->file.size(); ++i)
            script->file[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
        queue.addSource(1, source);
    }
    std::vector<Loaded> go(LoadQueue::Clock::time_point now = start) {
        queue.start(limits, 0, now);
        source.pump({});
        return queue.take(now);
    }
    Bytes bytes(ByteRange range) const {
        auto from = script->file.begin() + static_cast<std::ptrdiff_t>(range.offset);
        return Bytes(from, from + static_cast<std::ptrdiff_t>(range.size));
    }
};

} // namespace

TEST_CASE("merged ranges give each item its own bytes") {
    Loading loading;
    std::vector<LoadItem> items{item(1, {500, 100}), item(2, {200, 250}), item(3, {640, 10}),
                                item(4, {5000, 300}), item(5, {620, 40})};
    loading.queue.want(items);
    std::vector<Loaded> loaded = loading.go();
    CHECK(loading.script->reads == std::vector<ByteRange>{{200, 460}, {5000, 300}});
    CHECK(loading.counters.requests == 2);
    CHECK(loading.counters.requestsMerged == 3);
    REQUIRE(loaded.size() == 5);
    for (const Loaded& one : loaded) {
        REQUIRE(one.bytes.ok());
        CHECK(*one.bytes == loading.bytes(one.item.range));
    }
    CHECK(loading.queue.idle());
}

TEST_CASE("a gap too wide, a request too large, and another file are not merged") {
    Loading loading;
    ScriptedSource other(loading.script);
    loading.queue.addSource(2, other);
    loading.queue.want({item(1, {0, 900}), item(2, {950, 60}), item(3, {1200, 50}), item(4, {1260, 5}, 2)});
    loading.limits.requests = 10;
    loading.queue.start(loading.limits, 0, start);
    CHECK(loading.script->reads == std::vector<ByteRange>{{0, 900}, {950, 60}, {1200, 50}, {1260, 5}});
}

TEST_CASE("the most urgent goes first, within the limits, and what is held elsewhere counts") {
    Loading loading;
    loading.limits = {2, 10'000, 0, 1};
    loading.queue.want({item(1, {50'000, 4000}), item(2, {0, 4000}), item(3, {20'000, 10})});
    loading.queue.start(loading.limits, 3000, start);
    CHECK(loading.script->reads == std::vector<ByteRange>{{50'000, 4000}});
    loading.queue.start(loading.limits, 0, start);
    CHECK(loading.script->reads.size() == 2);
    CHECK(loading.script->reads[1] == ByteRange{0, 4000});
    loading.queue.start(loading.limits, 0, start); // two requests are on their way
    CHECK(loading.script->reads.size() == 2);
    loading.source.pump({});
    CHECK(loading.queue.take(start).size() == 2);
    loading.queue.start(loading.limits, 0, start);
    CHECK(loading.script->reads.size() == 3);
}

TEST_CASE("a range larger than the limit of bytes is asked for by itself") {
    Loading loading;
    loading.limits.bytes = 100;
    loading.queue.want({item(1, {0, 5000}), item(2, {9000, 10})});
    std::vector<Loaded> loaded = loading.go();
    REQUIRE(loaded.size() == 1);
    CHECK(loaded[0].bytes->size() == 5000);
    CHECK(loading.go().size() == 1);
}

TEST_CASE("a request is cancelled when nothing of it is wanted any more, not before") {
    Loading loading;
    loading.queue.want({item(1, {0, 50}), item(2, {60, 50})});
    loading.queue.start(loading.limits, 0, start);
    loading.queue.want({item(2, {60, 50})});
    CHECK(loading.script->cancelled == 0);
    loading.queue.want({});
    CHECK(loading.script->cancelled == 1);
    CHECK(loading.queue.requestsInFlight() == 0);
    CHECK(loading.queue.take(start).empty());
    CHECK(loading.queue.idle());
    CHECK(loading.counters.requestsCancelled == 1);
    // Wanted again, it is asked for again.
    loading.queue.want({item(1, {0, 50})});
    CHECK(loading.go().size() == 1);
}

TEST_CASE("what is on its way is not asked for again") {
    Loading loading;
    loading.queue.want({item(1, {0, 50})});
    loading.queue.start(loading.limits, 0, start);
    loading.queue.want({item(1, {0, 400})});
    loading.queue.start(loading.limits, 0, start);
    CHECK(loading.script->reads.size() == 1);
    loading.source.pump({});
    std::vector<Loaded> loaded = loading.queue.take(start);
    REQUIRE(loaded.size() == 1);
    CHECK(loaded[0].item.range.size == 50);
}

TEST_CASE("a failure that may pass is tried four times with growing pauses, then answered") {
    Loading loading;
    loading.script->failure = [](ByteRange) { return Error{ErrorCode::networkFailed, "down", "", ""}; };
    loading.queue.want({item(1, {0, 50})});
    auto now = start;
    for (int attempt = 1; attempt < LoadQueue::maxAttempts; ++attempt) {
        CHECK(loading.go(now).empty());
        CHECK(loading.script->reads.size() == static_cast<std::size_t>(attempt));
        auto pause = loading.queue.pauseAfter(attempt);
        CHECK(loading.queue.nextRetry() == now + pause);
        REQUIRE(loading.queue.passingFailure());
        CHECK(loading.queue.passingFailure()->what == "down");
        CHECK(loading.go(now + pause - std::chrono::milliseconds(1)).empty());
        CHECK(loading.script->reads.size() == static_cast<std::size_t>(attempt));
        now += pause;
    }
    std::vector<Loaded> loaded = loading.go(now);
    REQUIRE(loaded.size() == 1);
    CHECK(loaded[0].bytes.error().code == ErrorCode::networkFailed);
    CHECK(loading.counters.requestsFailed == 4);
    CHECK(loading.queue.idle());
    CHECK_FALSE(loading.queue.passingFailure());
}

TEST_CASE("while something is tried again it is known why, and no longer once it has come") {
    Loading loading;
    loading.script->failure = [](ByteRange) { return Error{ErrorCode::networkFailed, "down", "", ""}; };
    loading.queue.want({item(1, {0, 50}), item(2, {5000, 50})});
    CHECK(loading.go().empty());
    loading.script->failure = nullptr;
    loading.script->holdAnswers = true;
    auto later = start + loading.queue.pauseAfter(1);
    CHECK(loading.go(later).empty());
    REQUIRE(loading.queue.passingFailure()); // both are on their way
    CHECK(loading.queue.passingFailure()->what == "down");
    loading.script->holdAnswers = false;
    CHECK(loading.go(later).size() == 2);
    CHECK_FALSE(loading.queue.passingFailure());
}

TEST_CASE("a failure that can't pass is answered at once") {
    auto code = GENERATE(ErrorCode::changed, ErrorCode::notFound, ErrorCode::unsupported);
    Loading loading;
    loading.script->failure = [&](ByteRange) { return Error{code, "", "", ""}; };
    loading.queue.want({item(1, {0, 50})});
    std::vector<Loaded> loaded = loading.go();
    REQUIRE(loaded.size() == 1);
    CHECK(loaded[0].bytes.error().code == code);
}

TEST_CASE("a file that ends early fails the items beyond its end, and only those, after one more attempt") {
    Loading loading;
    loading.script->file.resize(120);
    loading.queue.want({item(1, {0, 100}), item(2, {110, 50})});
    std::vector<Loaded> loaded = loading.go();
    REQUIRE(loaded.size() == 1);
    CHECK(loaded[0].bytes.ok());
    loaded = loading.go(start + loading.queue.pauseAfter(1));
    REQUIRE(loaded.size() == 1);
    REQUIRE_FALSE(loaded[0].bytes.ok());
    CHECK(loaded[0].bytes.error().code == ErrorCode::truncated);
    CHECK(loading.script->reads.size() == 2);
}

TEST_CASE("a source that refuses is asked for nothing more until retry") {
    auto code = GENERATE(ErrorCode::accessDenied, ErrorCode::unsupported);
    Loading loading;
    loading.script->failure = [&](ByteRange) { return Error{code, "no", "", ""}; };
    loading.queue.want({item(1, {0, 50})});
    CHECK(loading.go().size() == 1);
    REQUIRE(loading.queue.stopped(1));
    loading.queue.want({item(2, {0, 50})});
    CHECK(loading.go().empty());
    CHECK(loading.script->reads.size() == 1);
    loading.queue.retry(1);
    loading.script->failure = nullptr;
    loading.queue.want({item(2, {0, 50})});
    CHECK(loading.go().size() == 1);
}

TEST_CASE("bytes that were here before come before those that were fetched") {
    Loading loading;
    LoadItem wanted = item(1, {30, 20});
    wanted.head = loading.bytes({10, 20});
    loading.queue.want({wanted});
    std::vector<Loaded> loaded = loading.go();
    REQUIRE(loaded.size() == 1);
    CHECK(*loaded[0].bytes == loading.bytes({10, 40}));
    CHECK(loading.counters.bytesRequested == 20);
}

TEST_CASE("a source that is removed answers nothing any more") {
    Loading loading;
    loading.queue.want({item(1, {0, 50}), item(2, {5000, 50})});
    loading.queue.start(loading.limits, 0, start);
    loading.queue.removeSource(1);
    CHECK(loading.script->cancelled == 2);
    CHECK(loading.queue.idle());
    CHECK(loading.queue.take(start).empty());
    CHECK_FALSE(loading.queue.awaits(1));
}
