#include "client/core/clip_boxes.hpp"

#include <algorithm>

namespace stipple {

namespace {

Overlap mostOf(const std::vector<ConvexRegion>& regions, const BoxD& box) {
    Overlap most = Overlap::none;
    for (const ConvexRegion& region : regions)
        most = std::max(most, region.overlapOf(box));
    return most;
}

bool anyHolds(const std::vector<ConvexRegion>& regions, Vec3d point) {
    return std::any_of(regions.begin(), regions.end(),
                       [&](const ConvexRegion& region) { return region.contains(point); });
}

void copyNear(const std::vector<ConvexRegion>& from, const BoxD& box, std::vector<ConvexRegion>& to) {
    for (const ConvexRegion& region : from)
        if (region.overlapOf(box) != Overlap::none)
            to.push_back(region);
}

} // namespace

Result<ClipBoxes> ClipBoxes::make(std::span<const ClipBox> boxes) {
    ClipBoxes made;
    for (const ClipBox& box : boxes) {
        STIPPLE_TRY(region, orientedBox(box.centre, box.halfSize * 2, box.axes, false));
        std::vector<ConvexRegion>& kind = box.mode == ClipMode::highlight    ? made.highlight_
                                          : box.mode == ClipMode::hideInside ? made.hideInside_
                                                                             : made.hideOutside_;
        kind.push_back(std::move(region));
    }
    return made;
}

ClipVerdict ClipBoxes::clipVerdict(const BoxD& box) const {
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

ClipBoxes ClipBoxes::near(const BoxD& box) const {
    ClipBoxes some;
    copyNear(hideInside_, box, some.hideInside_);
    copyNear(hideOutside_, box, some.hideOutside_);
    copyNear(highlight_, box, some.highlight_);
    // None of them is near: all points are outside, which only a box elsewhere says.
    if (some.hideOutside_.empty() && !hideOutside_.empty())
        some.hideOutside_.push_back(hideOutside_.front());
    return some;
}

bool ClipBoxes::hides(Vec3d point) const {
    return anyHolds(hideInside_, point) || (!hideOutside_.empty() && !anyHolds(hideOutside_, point));
}

bool ClipBoxes::highlights(Vec3d point) const {
    return anyHolds(highlight_, point);
}

} // namespace stipple
