#include "client/bench/replay.hpp"

#include "client/headless/session_loader.hpp"
#include "client/headless/thread_decoder.hpp"
#include "client/measure/comparison.hpp"
#include "shared/io/file_source.hpp"

namespace stipple::bench {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

class Replay {
  public:
    Replay(const ReplayRequest& request, headless::FrameDrawer& drawer)
        : request_(request), drawer_(drawer), decoder_(makeThreadDecoder(request.threads)),
          session_(ViewSession::create(*decoder_, request.limits)),
          loader_(*session_, request.cloud, request.timeout), frames_(request.path->cameras.size()) {}

    Result<std::vector<FrameResult>> run() {
        STIPPLE_CHECK(open());
        for (std::size_t i = 0; i < frames_.size(); ++i)
            STIPPLE_CHECK(coldFrame(i));
        std::vector<std::vector<double>> selects(frames_.size()), draws(frames_.size());
        for (int pass = 0; pass < request_.repeats; ++pass)
            for (std::size_t i = 0; i < frames_.size(); ++i)
                STIPPLE_CHECK(warmFrame(i, selects[i], draws[i]));
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            frames_[i].select = spreadOf(selects[i]);
            frames_[i].draw = spreadOf(draws[i]);
        }
        return std::move(frames_);
    }

  private:
    // Nothing is wanted before the first camera is set.
    Status open() {
        session_->setViewport(request_.width, request_.height);
        session_->setStyle(request_.style);
        SessionLimits opening = request_.limits;
        opening.pointBudget = 0;
        session_->setLimits(opening);
        STIPPLE_TRY(source, openFileSource(request_.cloud));
        session_->addCloud(std::move(source), request_.cloud);
        STIPPLE_CHECK(loader_.until([&] { return session_->clouds().front().stage == CloudStage::ready; }));
        session_->setCamera(request_.path->cameras.front());
        session_->setLimits(request_.limits);
        return {};
    }

    Status coldFrame(std::size_t i) {
        FrameResult& frame = frames_[i];
        SessionCounters before =
            i == 0 ? SessionCounters{} : session_->counters(); // opening counts for the first
        auto start = Clock::now();
        session_->setCamera(request_.path->cameras[i]);
        STIPPLE_CHECK(loader_.until([&] { return session_->settled(); }));
        frame.loadSeconds = secondsSince(start);
        SessionCounters after = session_->counters();
        frame.bytesFetched = after.bytesReceived - before.bytesReceived;
        frame.requests = after.requests - before.requests;

        FramePlan plan = session_->plan();
        STIPPLE_TRY(image, drawer_.draw(plan));
        STIPPLE_TRY(distances, drawer_.distances(plan));
        frame.counters = plan.counters;
        return judge(i, {*image, std::move(distances)});
    }

    Status judge(std::size_t i, DepthImage picture) {
        FrameResult& frame = frames_[i];
        STIPPLE_TRY(reference, request_.reference(i));
        STIPPLE_TRY(comparison, measure::compare(reference, picture));
        frame.pixels = comparison.pixels;
        frame.ssim = comparison.ssim;
        frame.flip = comparison.flip;
        frame.depth = comparison.depth;
        if (i > 0) {
            frame.change = measure::pixelError(last_, picture.image).mean;
            frame.referenceChange = measure::pixelError(lastReference_, reference.image).mean;
        }
        if (request_.show)
            request_.show(i, reference, picture.image, comparison.flipErrors);
        last_ = std::move(picture.image);
        lastReference_ = std::move(reference.image);
        return {};
    }

    Status warmFrame(std::size_t i, std::vector<double>& selects, std::vector<double>& draws) {
        SessionCounters before = session_->counters();
        session_->setCamera(request_.path->cameras[i]);
        if (frames_.size() == 1) // the camera did not move: make the session look again
            session_->setLimits(request_.limits);
        auto start = Clock::now();
        session_->update();
        selects.push_back(secondsSince(start));
        STIPPLE_CHECK(loader_.until([&] { return session_->settled(); }));
        frames_[i].bytesReloaded += session_->counters().bytesReceived - before.bytesReceived;

        FramePlan plan = session_->plan();
        start = Clock::now();
        STIPPLE_TRY(image, drawer_.draw(plan));
        draws.push_back(secondsSince(start));
        (void)image;
        return {};
    }

    const ReplayRequest& request_;
    headless::FrameDrawer& drawer_;
    std::unique_ptr<NodeDecoder> decoder_;
    std::unique_ptr<ViewSession> session_;
    headless::SessionLoader loader_;
    std::vector<FrameResult> frames_;
    Image last_, lastReference_;
};

} // namespace

Result<std::vector<FrameResult>> replay(const ReplayRequest& request, headless::FrameDrawer& drawer) {
    return Replay(request, drawer).run();
}

} // namespace stipple::bench
