#include "client/core/clips.hpp"

#include <algorithm>

namespace stipple {

namespace {

Overlap mostOf(const std::vector<PointRegion>& regions, const BoxD& box) {
    Overlap most = Overlap::none;
    for (const PointRegion& region : regions)
        most = std::max(most, region.overlapOf(box));
    return most;
}

bool anyHolds(const std::vector<PointRegion>& regions, Vec3d point) {
    return std::any_of(regions.begin(), regions.end(),
                       [&](const PointRegion& region) { return region.contains(point); });
}

void copyNear(const std::vector<PointRegion>& from, const BoxD& box, std::vector<PointRegion>& to) {
    for (const PointRegion& region : from)
        if (region.overlapOf(box) != Overlap::none)
            to.push_back(region.near(box));
}

} // namespace

Result<Clips> Clips::make(std::span<const ClipBox> boxes, std::span<const ClipRegion> regions) {
    Clips made;
    for (const ClipBox& box : boxes) {
        RegionShape shape;
        shape.box = RegionShape::Box{box.centre, box.halfSize, box.axes};
        STIPPLE_CHECK(made.add(shape, box.mode));
    }
    for (const ClipRegion& region : regions)
        STIPPLE_CHECK(made.add(region.shape, region.mode));
    return made;
}

Status Clips::add(const RegionShape& shape, ClipMode mode) {
    STIPPLE_TRY(filter, filterOf(shape));
    std::vector<PointRegion>& kind = mode == ClipMode::highlight    ? highlight_
                                     : mode == ClipMode::hideInside ? hideInside_
                                                                    : hideOutside_;
    kind.emplace_back(filter);
    return {};
}

ClipVerdict Clips::clipVerdict(const BoxD& box) const {
    ClipVerdict verdict;
    if (empty() || box.empty())
        return verdict;
    Overlap inHiding = mostOf(hideInside_, box);
    Overlap inShowing = hideOutside_.empty() ? Overlap::whole : mostOf(hideOutside_, box);
    verdict.hidden = inHiding == Overlap::whole || inShowing == Overlap::none;
    verdict.tested = !verdict.hidden && (inHiding == Overlap::partial || inShowing == Overlap::partial);
    verdict.highlighted = !verdict.hidden && mostOf(highlight_, box) != Overlap::none;
    return verdict;
}

Clips Clips::near(const BoxD& box) const {
    Clips some;
    copyNear(hideInside_, box, some.hideInside_);
    copyNear(hideOutside_, box, some.hideOutside_);
    copyNear(highlight_, box, some.highlight_);
    // None of them is near: all points are outside, which only one elsewhere says.
    if (some.hideOutside_.empty() && !hideOutside_.empty())
        some.hideOutside_.push_back(hideOutside_.front());
    return some;
}

bool Clips::hides(Vec3d point) const {
    return anyHolds(hideInside_, point) || (!hideOutside_.empty() && !anyHolds(hideOutside_, point));
}

bool Clips::highlights(Vec3d point) const {
    return anyHolds(highlight_, point);
}

} // namespace stipple
