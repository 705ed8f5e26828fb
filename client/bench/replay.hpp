// One camera path through a session, with one mode and budget: first cold, every frame until all that it
// wants is there, compared with its reference; then warm, again and again, for the times.
#pragma once

#include "client/bench/results.hpp"
#include "client/measure/plane.hpp"
#include "shared/base/result.hpp"

#include <chrono>
#include <functional>
#include <string>

namespace stipple::bench {

struct ReplayRequest {
    std::string cloud; // path of the file
    const CameraPath* path = nullptr;
    Style style; // with ranges
    SessionLimits limits;
    int width = 0, height = 0;
    int repeats = 3; // warm passes; 0: no times
    int threads = 0; // of decoding and the software renderer
    std::chrono::milliseconds timeout{600'000};
    // The reference of a frame.
    std::function<Result<DepthImage>(std::size_t frame)> reference;
    // Called with each frame of the first pass; may be empty.
    std::function<void(std::size_t frame, const DepthImage& reference, const Image& picture,
                       const measure::Plane<float>& flip)>
        show;
};

// Errors: those of opening, loading, drawing and of the reference.
Result<std::vector<FrameResult>> replay(const ReplayRequest& request, headless::FrameDrawer& drawer);

} // namespace stipple::bench
