#include "tests/bench/streaming_run.hpp"

#include "client/headless/session_loader.hpp"
#include "client/headless/thread_decoder.hpp"
#include "client/measure/pixel_error.hpp"
#include "client/render/software_renderer.hpp"
#include "shared/io/file_source.hpp"

#include <algorithm>
#include <map>

namespace stipple::test {

namespace {

using namespace std::chrono_literals;
constexpr auto frame = std::chrono::nanoseconds(1'000'000'000 / 60); // at least as often the session looks

// What is shown from a moment on.
struct Shown {
    Milestone cost; // since the camera was set
    FramePlan plan;
};

class Run {
  public:
    Run(const StreamingScene& scene, const StreamingWay& way, const NetworkOptions& options)
        : scene_(scene), network_(options), decoder_(makeInlineDecoder()),
          session_(ViewSession::create(*decoder_, way.limits, [this] { return network_.now(); })),
          renderer_(SoftwareRenderer::create()) {
        session_->setViewport(scene.width, scene.height);
        session_->setStyle(way.style);
    }

    Result<StreamingResult> run(const std::vector<double>& at) {
        session_->setCamera(scene_.cameras.front());
        session_->addCloud(network_.open(scene_.file, scene_.name), scene_.name);
        for (std::size_t i = 0; i < scene_.cameras.size(); ++i) {
            STIPPLE_TRY(shown, look(scene_.cameras[i]));
            judge(shown, scene_.targets[i], i == 0);
            for (double seconds : i == 0 ? at : std::vector<double>())
                result_.pictures.push_back(pictureAt(shown, seconds));
        }
        result_.settledError /= static_cast<double>(scene_.cameras.size());
        result_.session = session_->counters();
        result_.network = network_.counters();
        return result_;
    }

  private:
    Milestone cost() const {
        return {true, std::chrono::duration<double>(network_.now().time_since_epoch()).count(),
                static_cast<double>(network_.counters().requests),
                static_cast<double>(network_.counters().bytesCarried)};
    }

    // Everything that is shown until the view has settled.
    Result<std::vector<Shown>> look(const Camera& camera) {
        session_->setCamera(camera);
        Milestone start = cost();
        auto end = network_.now() + 1h;
        std::vector<Shown> shown;
        do {
            if (session_->update() || shown.empty()) {
                Milestone now = cost();
                shown.push_back({{true, now.seconds - start.seconds, now.requests - start.requests,
                                  now.bytes - start.bytes},
                                 session_->plan()});
            }
            if (!session_->settled())
                network_.advance(frame);
            if (network_.now() > end)
                return Error{ErrorCode::limitExceeded, "the view has not settled within an hour", scene_.name,
                             ""};
        } while (!session_->settled());
        if (auto errors = session_->recentErrors(); !errors.empty())
            return errors.front();
        return shown;
    }

    Image pictureAt(std::vector<Shown>& shown, double seconds) {
        auto later = std::find_if(shown.begin() + 1, shown.end(),
                                  [&](const Shown& one) { return one.cost.seconds > seconds; });
        return renderer_->render(std::prev(later)->plan);
    }

    // What is fetched later only adds, so the error falls, and where it passes a level is found by bisection.
    void judge(std::vector<Shown>& shown, const Image& target, bool isFirst) {
        std::map<std::size_t, double> known;
        auto errorOf = [&](std::size_t i) {
            auto [at, isNew] = known.emplace(i, 0.0);
            if (isNew)
                at->second = measure::pixelError(target, renderer_->render(shown[i].plan)).mean / 255;
            return at->second;
        };
        if (isFirst) {
            auto first = std::find_if(shown.begin(), shown.end(),
                                      [](const Shown& one) { return one.plan.counters.pointsDrawn > 0; });
            if (first != shown.end())
                result_.firstPicture = first->cost;
        }
        double last = errorOf(shown.size() - 1);
        for (std::size_t level = 0; level < errorLevels.size(); ++level) {
            std::size_t low = 0, high = shown.size() - 1;
            Milestone reached = shown.back().cost;
            reached.isReached = last < errorLevels[level];
            while (reached.isReached && low < high) {
                std::size_t middle = (low + high) / 2;
                if (errorOf(middle) < errorLevels[level])
                    high = middle;
                else
                    low = middle + 1;
            }
            if (reached.isReached)
                reached = shown[high].cost;
            result_.belowError[level] += reached;
        }
        result_.settled += shown.back().cost;
        result_.settledError += last;
    }

    const StreamingScene& scene_;
    SimulatedNetwork network_; // outlives the session
    std::unique_ptr<NodeDecoder> decoder_;
    std::unique_ptr<ViewSession> session_;
    std::unique_ptr<SoftwareRenderer> renderer_;
    StreamingResult result_;
};

} // namespace

Milestone& Milestone::operator+=(const Milestone& other) {
    isReached = isReached && other.isReached;
    seconds += other.seconds;
    requests += other.requests;
    bytes += other.bytes;
    return *this;
}

StreamingResult& StreamingResult::operator+=(const StreamingResult& other) {
    firstPicture += other.firstPicture;
    for (std::size_t level = 0; level < belowError.size(); ++level)
        belowError[level] += other.belowError[level];
    settled += other.settled;
    settledError += other.settledError;
    return *this;
}

Result<StreamingResult> runStreaming(const StreamingScene& scene, const StreamingWay& way,
                                     const NetworkOptions& network, const std::vector<double>& at) {
    return Run(scene, way, network).run(at);
}

Result<std::vector<Image>> targetPictures(const std::string& path, const std::vector<Camera>& cameras,
                                          int width, int height) {
    SessionLimits limits;
    limits.pointBudget = 1ull << 40;
    limits.cacheBytes = 1ull << 34;
    limits.minNodePixels = 0;
    auto decoder = makeThreadDecoder();
    auto session = ViewSession::create(*decoder, limits);
    auto renderer = SoftwareRenderer::create();
    session->setViewport(width, height);
    session->setCamera(cameras.front());
    STIPPLE_TRY(source, openFileSource(path));
    session->addCloud(std::move(source), path);
    headless::SessionLoader loader(*session, path, 10min);
    std::vector<Image> pictures;
    for (const Camera& camera : cameras) {
        session->setCamera(camera);
        session->update();
        STIPPLE_CHECK(loader.until([&] { return session->settled(); }));
        FramePlan plan = session->plan();
        pictures.push_back(renderer->render(plan));
    }
    return pictures;
}

} // namespace stipple::test
