// A camera that moves while what it sees is fetched over a simulated network, on its virtual clock: how far
// what is shown is from the picture of all points all along the way, and what the way cost.
//
//   rest at the first camera ─ the flight ─ rest at the last ─ back to the first
//   until settled              `seconds`    until settled      until settled
//
// The session is updated at 60 frames a second, as a page is. Errors are taken at even times, from the
// beginning of the flight to `restSeconds` after its end, always against the camera of that moment.
#pragma once

#include "client/bench/camera_path.hpp"
#include "tests/bench/streaming_run.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace stipple::test {

inline constexpr double flightFramesPerSecond = 60;

// Names of flights:
//   fly-over  the path of that name (camera_path.hpp), at an even speed
//   walk      likewise
//   wild      to another place of the path `jump` every 40 ms
//   wheel     an oblique view of everything that comes nearer to a place by a seventh with each step of a
//             wheel (that of the page): four steps, 80 ms apart, every 1.2 s
std::vector<std::string_view> flightNames();

// A camera a frame, from the first to the last moment; at least two. Error: invalidArgument for an unknown
// name.
Result<std::vector<Camera>> flightCameras(std::string_view name, const BoxD& content, double seconds,
                                          double aspect);

struct FlightScene {
    std::string name;
    std::shared_ptr<const HostedFile> file;
    std::vector<Camera> cameras;      // one a frame
    std::vector<std::size_t> samples; // frames at which the error is taken; those beyond the last are at rest
    std::vector<Image> targets;       // of all points, one for each sample
    int width = 1280, height = 720;
};

struct FlightResult {
    double flyingError = 0, restError = 0; // means over the samples on the way and at rest, parts of 255
    double restSeconds = 0;                // from the last camera until nothing more was wanted
    NetworkCounters network;               // until then, without what the rest at the first camera took
    SessionCounters session;               // likewise; of the whole run where it is no sum
    std::uint64_t returnRequests = 0;      // that going back to the first camera took
};

// Errors: of the session; limitExceeded if a view does not settle within an hour of the virtual clock.
Result<FlightResult> fly(const FlightScene& scene, const StreamingWay& way, const NetworkOptions& network);

} // namespace stipple::test
