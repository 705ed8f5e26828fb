#include "tests/bench/settled_viewer.hpp"

#include "client/headless/session_loader.hpp"
#include "client/headless/thread_decoder.hpp"
#include "shared/io/file_source.hpp"

namespace stipple {

void endBench(const Error& error) {
    std::fprintf(stderr, "%s\n", error.sentence().c_str());
    std::exit(1);
}

SettledViewer::SettledViewer(const std::string& path, int width, int height)
    : path_(path), decoder_(makeThreadDecoder(2)) {
    SessionLimits limits;
    limits.cacheBytes = 4ull << 30;
    limits.pointBudget = 0; // nothing is wanted before there is a camera
    session_ = ViewSession::create(*decoder_, limits);
    session_->setViewport(width, height);
    session_->addCloud(need(openFileSource(path)), path);
    settle([&] { return session_->clouds()[0].stage == CloudStage::ready; });
    metadata_ = session_->clouds()[0].metadata;
}

SettledViewer::~SettledViewer() = default;

void SettledViewer::settle(const std::function<bool()>& done) {
    headless::SessionLoader loader(*session_, path_, std::chrono::minutes(5));
    need(loader.until(done));
}

const FramePlan& SettledViewer::plan(const Camera& camera, const Style& style, std::uint64_t pointBudget,
                                     double minNodePixels) {
    SessionLimits limits = session_->limits();
    limits.pointBudget = pointBudget;
    limits.minNodePixels = minNodePixels;
    session_->setLimits(limits);
    session_->setStyle(style);
    session_->setCamera(camera);
    session_->update();
    settle([&] { return session_->settled(); });
    return session_->plan();
}

} // namespace stipple
