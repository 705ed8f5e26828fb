#include "tests/bench/flight.hpp"

#include "client/measure/pixel_error.hpp"
#include "client/render/software_renderer.hpp"

#include <algorithm>

namespace stipple::test {

namespace {

using namespace std::chrono_literals;
constexpr auto frameTime = std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / flightFramesPerSecond));

class Flight {
  public:
    Flight(const FlightScene& scene, const StreamingWay& way, const NetworkOptions& options)
        : scene_(scene), network_(options), decoder_(makeInlineDecoder()),
          session_(ViewSession::create(*decoder_, way.limits, [this] { return network_.now(); })),
          renderer_(SoftwareRenderer::create()) {
        session_->setViewport(scene.width, scene.height);
        session_->setStyle(way.style);
    }

    Result<FlightResult> run() {
        session_->setCamera(scene_.cameras.front());
        session_->addCloud(network_.open(scene_.file, scene_.name), scene_.name);
        STIPPLE_CHECK(settle());
        NetworkCounters before = network_.counters();
        SessionCounters sessionBefore = session_->counters();
        auto last = std::max(scene_.samples.back() + 1, scene_.cameras.size());
        for (std::size_t frame = 0; frame < last; ++frame)
            pass(frame);
        STIPPLE_CHECK(settle());
        result_.restSeconds =
            std::chrono::duration<double>(settledAt_.value_or(network_.now()) - restsSince_).count();
        takeCounts(before, sessionBefore);
        session_->setCamera(scene_.cameras.front());
        session_->update();
        std::uint64_t requests = network_.counters().requests;
        STIPPLE_CHECK(settle());
        result_.returnRequests = network_.counters().requests - requests;
        return result_;
    }

  private:
    Status settle() {
        auto end = network_.now() + 1h;
        session_->update();
        while (!session_->settled()) {
            if (network_.now() > end)
                return Error{ErrorCode::limitExceeded, "the view has not settled within an hour", scene_.name,
                             ""};
            network_.advance(frameTime);
            session_->update();
        }
        if (auto errors = session_->recentErrors(); !errors.empty())
            return errors.front();
        return {};
    }

    // One frame: the camera, what is shown with it, and the time until the next.
    void pass(std::size_t frame) {
        session_->setCamera(scene_.cameras[std::min(frame, scene_.cameras.size() - 1)]);
        if (frame == scene_.cameras.size() - 1)
            restsSince_ = network_.now();
        session_->update();
        judge(frame);
        auto until = network_.now() + frameTime;
        while (network_.now() < until)
            if (network_.advance(until - network_.now()))
                session_->update();
        if (frame + 1 >= scene_.cameras.size() && !settledAt_ && session_->settled())
            settledAt_ = network_.now();
    }

    void judge(std::size_t frame) {
        auto sample = std::find(scene_.samples.begin(), scene_.samples.end(), frame);
        if (sample == scene_.samples.end())
            return;
        const Image& target = scene_.targets[static_cast<std::size_t>(sample - scene_.samples.begin())];
        FramePlan plan = session_->plan();
        double error = measure::pixelError(target, renderer_->render(plan)).mean / 255;
        bool isFlying = frame < scene_.cameras.size();
        auto flying = std::count_if(scene_.samples.begin(), scene_.samples.end(),
                                    [&](std::size_t at) { return at < scene_.cameras.size(); });
        auto resting = static_cast<std::ptrdiff_t>(scene_.samples.size()) - flying;
        (isFlying ? result_.flyingError : result_.restError) +=
            error / static_cast<double>(isFlying ? flying : resting);
    }

    void takeCounts(const NetworkCounters& before, const SessionCounters& sessionBefore) {
        result_.network = network_.counters();
        result_.network.requests -= before.requests;
        result_.network.bytesCarried -= before.bytesCarried;
        result_.network.bytesWasted -= before.bytesWasted;
        result_.session = session_->counters();
        result_.session.requestsCancelled -= sessionBefore.requestsCancelled;
        result_.session.requestsLetFinish -= sessionBefore.requestsLetFinish;
        result_.session.bytesFetchedTwice -= sessionBefore.bytesFetchedTwice;
    }

    const FlightScene& scene_;
    SimulatedNetwork network_; // outlives the session
    std::unique_ptr<NodeDecoder> decoder_;
    std::unique_ptr<ViewSession> session_;
    std::unique_ptr<SoftwareRenderer> renderer_;
    SimulatedNetwork::Time restsSince_{}; // the last camera
    std::optional<SimulatedNetwork::Time> settledAt_;
    FlightResult result_;
};

} // namespace

Result<FlightResult> fly(const FlightScene& scene, const StreamingWay& way, const NetworkOptions& network) {
    return Flight(scene, way, network).run();
}

} // namespace stipple::test
