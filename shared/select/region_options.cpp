#include "shared/select/region_options.hpp"

#include "shared/geometry/oriented_box.hpp"

#include <algorithm>
#include <limits>

namespace stipple {

namespace {

Error refused(const char* where, Phrase what, Phrase advice) {
    return {ErrorCode::invalidArgument, std::move(what), where, std::move(advice)};
}

Result<BoxAxes> axesOf(std::span<const double> rotation, bool anyHeight) {
    if (rotation.empty())
        return axesTurned(0);
    if (rotation.size() == 1)
        return axesTurned(rotation[0]);
    if (rotation.size() != 4 || anyHeight)
        return refused("rotation", say("it does not fit the box"),
                       say("give degrees about z, or for a box with x, y and z a quaternion x,y,z,w"));
    auto axes = axesOfQuaternion(rotation[0], rotation[1], rotation[2], rotation[3]);
    if (!axes)
        return refused("rotation", say("a quaternion of length 0 turns nothing"),
                       say("0,0,0,1 is no rotation"));
    return *axes;
}

} // namespace

Result<std::shared_ptr<const ConvexRegion>>
rotatedBox(std::span<const double> centre, std::span<const double> size, std::span<const double> rotation) {
    if (centre.size() != 2 && centre.size() != 3)
        return refused("center", say("it is no place"), say("give x,y or x,y,z"));
    if (size.size() != centre.size())
        return refused("size", say("it does not fit the centre"),
                       say("give as many sizes as the centre has coordinates"));
    if (std::any_of(size.begin(), size.end(), [](double s) { return s < 0; }))
        return refused("size", say("a size is negative"), say("give sizes of at least 0"));
    bool anyHeight = centre.size() == 2;
    STIPPLE_TRY(axes, axesOf(rotation, anyHeight));
    auto vectorOf = [&](std::span<const double> v) { return Vec3d{v[0], v[1], anyHeight ? 0 : v[2]}; };
    auto box = orientedBox(vectorOf(centre), vectorOf(size), axes, anyHeight);
    if (!box)
        return refused("center", box.error().what, "");
    return std::make_shared<const ConvexRegion>(*std::move(box));
}

void limitHeights(PointFilter& filter, ValueRange heights) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (!filter.box)
        filter.box = BoxD{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
    filter.box->min.z = std::max(filter.box->min.z, heights.min);
    filter.box->max.z = std::min(filter.box->max.z, heights.max);
}

} // namespace stipple
