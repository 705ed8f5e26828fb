#include "tests/bench/flight.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stipple::test {

namespace {

constexpr double jumpSeconds = 0.04, wheelSeconds = 0.08, wheelFactor = 0.86, burstSeconds = 1.2;
constexpr int burstSteps = 4;
constexpr std::array<std::string_view, 4> names{"fly-over", "walk", "wild", "wheel"};

// Of the path `jump`, the same for so many frames.
std::vector<Camera> wild(const BoxD& content, std::size_t frames) {
    double perJump = jumpSeconds * flightFramesPerSecond;
    int jumps = 1 + static_cast<int>(static_cast<double>(frames) / perJump);
    std::vector<Camera> places = bench::builtInPath("jump", content, jumps)->cameras, cameras;
    for (std::size_t i = 0; i < frames; ++i)
        cameras.push_back(places[static_cast<std::size_t>(static_cast<double>(i) / perJump)]);
    return cameras;
}

// Towards a place beside the middle, so that the direction changes, too.
std::vector<Camera> wheel(const BoxD& content, std::size_t frames, double aspect) {
    Camera camera = namedCamera(NamedView::iso, content, aspect);
    auto steps = [](std::size_t frame) {
        double seconds = static_cast<double>(frame) / flightFramesPerSecond;
        double bursts = std::floor(seconds / burstSeconds);
        int ofBurst = 1 + static_cast<int>((seconds - bursts * burstSeconds) / wheelSeconds);
        return static_cast<int>(bursts) * burstSteps + std::min(ofBurst, burstSteps);
    };
    std::vector<Camera> cameras;
    for (std::size_t i = 0; i < frames; ++i) {
        if (i > 0 && steps(i) > steps(i - 1))
            camera =
                zoomTo(camera, wheelFactor, 0.55 * aspect * 1000, 550, static_cast<int>(aspect * 1000), 1000);
        cameras.push_back(camera);
    }
    return cameras;
}

} // namespace

std::vector<std::string_view> flightNames() {
    return {names.begin(), names.end()};
}

Result<std::vector<Camera>> flightCameras(std::string_view name, const BoxD& content, double seconds,
                                          double aspect) {
    if (std::find(names.begin(), names.end(), name) == names.end())
        return Error{ErrorCode::invalidArgument, cat("there is no flight '", name, "'"), "--flights",
                     "choose of fly-over, walk, wild, wheel"};
    auto frames = std::max<std::size_t>(2, static_cast<std::size_t>(seconds * flightFramesPerSecond));
    if (name == "wild")
        return wild(content, frames);
    if (name == "wheel")
        return wheel(content, frames, aspect);
    STIPPLE_TRY(path, bench::builtInPath(name, content, static_cast<int>(frames)));
    return std::move(path.cameras);
}

} // namespace stipple::test
