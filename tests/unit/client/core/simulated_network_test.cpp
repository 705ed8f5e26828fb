#include "tests/support/simulated_network.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

using namespace stipple;
using namespace stipple::test;
using namespace std::chrono_literals;

namespace {

// 8 Mbit/s: a byte a microsecond. Without headers and slow beginnings times can be told in the head.
NetworkOptions plainNetwork() {
    NetworkOptions options;
    options.megabitsPerSecond = 8;
    options.roundTrip = 50ms;
    options.firstWindowBytes = 1e9;
    options.mostWindowBytes = 1e9;
    options.headerBytes = 0;
    return options;
}

std::shared_ptr<HostedFile> fileOf(std::size_t bytes) {
    auto file = std::make_shared<HostedFile>();
    file->bytes.resize(bytes);
    for (std::size_t i = 0; i < bytes; ++i)
        file->bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
    return file;
}

struct Scene {
    SimulatedNetwork network;
    std::shared_ptr<HostedFile> file = fileOf(1'000'000);
    std::unique_ptr<ByteSource> source;
    struct Answer {
        double milliseconds = -1;
        Result<Bytes> bytes = Bytes{};
    };
    std::vector<std::shared_ptr<Answer>> answers;

    explicit Scene(const NetworkOptions& options = plainNetwork())
        : network(options), source(network.open(file, "http://host/a.stipple")) {}

    ByteSource::RequestId read(ByteRange range) {
        auto answer = std::make_shared<Answer>();
        answers.push_back(answer);
        return source->read(range, [this, answer](Result<Bytes> bytes) {
            answer->milliseconds =
                std::chrono::duration<double, std::milli>(network.now().time_since_epoch()).count();
            answer->bytes = std::move(bytes);
        });
    }
    void run(SimulatedNetwork::Duration most = 1h) {
        auto end = network.now() + most;
        while (network.now() < end) {
            network.advance(end - network.now());
            source->pump({});
        }
    }
    double when(std::size_t i) const { return answers[i]->milliseconds; }
    ErrorCode code(std::size_t i) const { return answers[i]->bytes.error().code; }
};

} // namespace

TEST_CASE("a read takes a handshake, a round trip and its bytes; the next one no handshake") {
    Scene scene;
    scene.read({100, 10'000});
    scene.run(1s);
    CHECK(scene.when(0) == Approx(50 + 50 + 10));
    REQUIRE(scene.answers[0]->bytes.ok());
    CHECK(*scene.answers[0]->bytes ==
          Bytes(scene.file->bytes.begin() + 100, scene.file->bytes.begin() + 10'100));
    CHECK(scene.source->sizeBytes() == 1'000'000);
    scene.read({999'000, 5000}); // cut at the end of the file
    scene.run(1s);
    CHECK(scene.when(1) == Approx(1000 + 50 + 1));
    CHECK(scene.answers[1]->bytes->size() == 1000);
    CHECK(scene.network.counters().connectionsOpened == 1);
    CHECK(scene.network.counters().bytesCarried == 11'000);
}

TEST_CASE("answers share the link evenly, and what one does not need the other has") {
    Scene scene;
    scene.read({0, 100'000});
    scene.read({200'000, 300'000});
    scene.run();
    CHECK(scene.when(0) == Approx(100 + 200)); // half of the link
    CHECK(scene.when(1) == Approx(100 + 400)); // then all of it
}

TEST_CASE("more requests than connections wait for one, in their order") {
    NetworkOptions options = plainNetwork();
    options.connections = 2;
    Scene scene(options);
    for (std::uint64_t i = 0; i < 4; ++i)
        scene.read({i * 10'000, 10'000});
    scene.run();
    CHECK(scene.when(0) == Approx(120));
    CHECK(scene.when(1) == Approx(120));
    CHECK(scene.when(2) == Approx(120 + 50 + 20)); // its connection is open
    CHECK(scene.when(3) == Approx(120 + 50 + 20));
    CHECK(scene.network.counters().connectionsOpened == 2);
}

TEST_CASE("a new connection carries a window in each round trip, twice as much each time") {
    NetworkOptions options = plainNetwork();
    options.firstWindowBytes = 10'000;
    options.megabitsPerSecond = 8000; // a thousandth of the time
    Scene scene(options);
    scene.read({0, 65'000}); // 10,000, 20,000, then 35,000 of 40,000
    scene.run(1s);
    CHECK(scene.when(0) == Approx(100 + 50 + 50 + 0.035));
    scene.read({0, 65'000}); // 80,000 go at once by now
    scene.run(1s);
    CHECK(scene.when(1) == Approx(1000 + 50 + 0.065).margin(50.1)); // at most the rest of a round
    CHECK(scene.when(1) < 1101);
}

TEST_CASE("what is taken back is answered so, costs its connection, and weighs on the link for a while") {
    Scene scene;
    auto first = scene.read({0, 900'000});
    scene.run(300ms); // 200 ms of bytes have come
    scene.source->cancel(first);
    scene.run(100ms);
    CHECK(scene.code(0) == ErrorCode::cancelled);
    CHECK(scene.network.counters().bytesWasted == Approx(200'000 + 25'000));
    CHECK(scene.network.counters().bytesCarried == Approx(225'000));
    scene.read({0, 10'000});
    scene.run();
    CHECK(scene.when(1) == Approx(400 + 110)); // a handshake again
    CHECK(scene.network.counters().connectionsOpened == 2);
    // One that has not reached the server yet costs no bytes.
    scene.source->cancel(scene.read({0, 10'000}));
    scene.run(1s);
    CHECK(scene.network.counters().requests == 2);
    CHECK(scene.network.counters().bytesCarried == Approx(235'000));
}

TEST_CASE("each fault shows as what a client would see of it") {
    Scene scene;
    std::optional<Fault> fault;
    std::uint64_t last = 0;
    scene.network.fault = [&](std::uint64_t number, ByteRange range) {
        CHECK(range == ByteRange{0, 100'000});
        CHECK(number == ++last);
        return fault;
    };
    auto outcome = [&](Fault::Kind kind) -> Scene::Answer {
        fault = Fault{kind};
        scene.read({0, 100'000});
        scene.run(2min);
        return *scene.answers.back();
    };
    Scene::Answer reset = outcome(Fault::Kind::reset);
    CHECK(reset.bytes.error().code == ErrorCode::networkFailed);
    CHECK(reset.milliseconds == Approx(50 + 50 + 50)); // half of the body came
    CHECK(scene.network.counters().bytesWasted == 50'000);
    CHECK(outcome(Fault::Kind::status).bytes.error().what.find("503") != std::string::npos);
    CHECK(outcome(Fault::Kind::wholeFile).bytes.error().code == ErrorCode::unsupported);
    CHECK(isTimeout(outcome(Fault::Kind::silence).bytes.error()));
    Scene::Answer corrupt = outcome(Fault::Kind::corruptBody);
    REQUIRE(corrupt.bytes.ok());
    std::size_t differing = 0;
    for (std::size_t i = 0; i < corrupt.bytes->size(); ++i)
        differing += (*corrupt.bytes)[i] != scene.file->bytes[i];
    CHECK(differing == 1);
    fault.reset();
    scene.file->etag = "\"2\"";
    scene.read({0, 100'000});
    scene.run(1s);
    CHECK(scene.answers.back()->bytes.error().code == ErrorCode::changed);
    CHECK(last == 6);
}

TEST_CASE("a source that goes away answers what is open, and the network goes on") {
    Scene scene;
    scene.read({0, 500'000});
    scene.read({0, 10});
    scene.network.advance(120ms);
    scene.source.reset();
    CHECK(scene.code(0) == ErrorCode::cancelled);
    scene.source = scene.network.open(scene.file, "again");
    scene.read({0, 10'000});
    scene.run();
    CHECK(scene.answers.back()->bytes.ok());
}
