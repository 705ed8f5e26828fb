// A camera that goes through keyframes: what a film of a cloud is made of. It begins and ends at rest and
// passes each keyframe at its time, exactly. Between them each of these goes by itself along a monotone cubic
// (Fritsch and Carlson, SIAM J. Numer. Anal. 17, 1980; slopes of Fritsch and Butland, SIAM J. Sci. Stat.
// Comput. 5, 1984): x, y, z of the position, heading, elevation and roll about the first camera's `up`, the
// field of view, and the logarithms of the distance to the target and of the orthographic height. So nothing
// overshoots: a value never leaves the interval of its two keyframes; velocities have no jumps; keyframes on
// a line give a line; one that only turns stays in its place. Headings take the short way round.
#pragma once

#include "client/core/camera.hpp"
#include "shared/base/result.hpp"

#include <array>
#include <string_view>
#include <vector>

namespace stipple {

struct Keyframe {
    Camera camera;
    double seconds = 2; // since the keyframe before, in (0, 3600]; of the first it says nothing
    friend bool operator==(const Keyframe&, const Keyframe&) = default;
};

inline constexpr std::size_t maxKeyframes = 1000;

class CameraTrack {
  public:
    // Errors: invalidArgument for none, more than maxKeyframes, a camera that is not usable or looks nowhere,
    // a time outside of its range, perspective and orthographic cameras mixed.
    static Result<CameraTrack> make(std::vector<Keyframe> keyframes);

    double duration() const { return times_.back(); } // seconds; 0 with one keyframe
    Camera at(double seconds) const; // before the beginning and after the end: the first, the last

  private:
    // In this order: see above.
    enum Quantity { x, y, z, heading, elevation, roll, fieldOfView, logDistance, logHeight, quantities };
    using Values = std::array<double, quantities>;

    CameraTrack() = default;
    Values valuesOf(const Camera& camera) const;
    Camera cameraOf(const Values& values) const;
    void setSlopes();

    std::vector<Keyframe> keyframes_;
    std::vector<double> times_; // of the keyframes, ascending from 0
    std::vector<Values> values_, slopes_;
    Vec3d pole_, east_, north_; // orthonormal: headings turn from east_ to north_ about pole_
};

// {"keyframes": [{"camera": {…}, "seconds": 2}, …]}; cameras as in client/core/json.hpp.
Result<CameraTrack> cameraTrackFromJson(std::string_view text);

} // namespace stipple
