// One camera path over a simulated network, on its virtual clock: what was shown when, what it had cost by
// then, and how far it was from the picture of all points.
//
// A session without anything begins at the path's first camera; when all that a camera wants is there, the
// next one is set. Decoding and drawing take no time: what is measured is the network and the order of what
// is asked for.
#pragma once

#include "client/bench/camera_path.hpp"
#include "client/core/view_session.hpp"
#include "client/render/image.hpp"
#include "tests/support/simulated_network.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace stipple::test {

struct StreamingWay {
    std::string name;
    SessionLimits limits;
    Style style;
};

// A cloud, and the cameras from which it is looked at.
struct StreamingScene {
    std::string name;
    std::shared_ptr<const HostedFile> file;
    std::vector<Camera> cameras;
    std::vector<Image> targets; // of all points, one for each camera
    int width = 1280, height = 720;
};

struct Milestone {
    bool isReached = true;
    double seconds = 0;
    double requests = 0, bytes = 0; // that reached the server; over the link, with what was wasted

    Milestone& operator+=(const Milestone& other);
};

// Levels of the mean pixel error, of 255, as parts.
inline constexpr std::array<double, 3> errorLevels{0.10, 0.05, 0.02};

struct StreamingResult {
    Milestone firstPicture;                               // of the first camera
    std::array<Milestone, errorLevels.size()> belowError; // sums over the cameras, each from when it is set
    Milestone settled;                                    // likewise
    double settledError = 0;                              // mean over the cameras, as a part of 255
    SessionCounters session;
    NetworkCounters network;

    std::vector<Image> pictures; // what the first camera showed at the times that were asked for

    StreamingResult& operator+=(const StreamingResult& other); // another path of as many cameras
};

// `at`: seconds at which pictures are wanted, from setting the first camera.
// Errors: of the session; limitExceeded if a view does not settle within an hour of the virtual clock.
Result<StreamingResult> runStreaming(const StreamingScene& scene, const StreamingWay& way,
                                     const NetworkOptions& network, const std::vector<double>& at = {});

// The pictures of all points.
Result<std::vector<Image>> targetPictures(const std::string& path, const std::vector<Camera>& cameras,
                                          int width, int height);

} // namespace stipple::test
