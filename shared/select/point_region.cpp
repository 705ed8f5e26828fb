#include "shared/select/point_region.hpp"

#include <algorithm>

namespace stipple {

namespace {

Overlap overlapOfBoxes(const BoxD& region, const BoxD& box) {
    if (region.contains(box.min) && region.contains(box.max))
        return Overlap::whole;
    for (int axis = 0; axis < 3; ++axis)
        if (box.max[axis] < region.min[axis] || box.min[axis] > region.max[axis])
            return Overlap::none;
    return Overlap::partial;
}

} // namespace

PointRegion::PointRegion(const PointFilter& filter)
    : box_(filter.box), polygons_(filter.region), convex_(filter.convex), prism_(filter.prism),
      corridor_(filter.corridor) {
    if (corridor_)
        corridorParts_ = corridor_->partsNear(corridor_->bounds());
}

Overlap PointRegion::overlapOf(const BoxD& box) const {
    Overlap overlap = isNowhere_ ? Overlap::none : Overlap::whole;
    auto meet = [&](const auto& part, auto overlapOfPart) {
        if (part && overlap != Overlap::none)
            overlap = std::min(overlap, overlapOfPart(*part));
    };
    auto ask = [&](const auto& part) { return part.overlapOf(box); };
    meet(box_, [&](const BoxD& region) { return overlapOfBoxes(region, box); });
    meet(polygons_, ask);
    meet(convex_, ask);
    meet(prism_, ask);
    meet(corridor_, ask);
    return overlap;
}

PointRegion PointRegion::near(const BoxD& box) const {
    PointRegion some(*this);
    some.isNowhere_ = overlapOf(box) == Overlap::none;
    auto drop = [&](auto& part, Overlap overlap) {
        if (overlap == Overlap::whole)
            part.reset();
    };
    if (box_)
        drop(some.box_, overlapOfBoxes(*box_, box));
    if (polygons_)
        drop(some.polygons_, polygons_->overlapOf(box));
    if (convex_)
        drop(some.convex_, convex_->overlapOf(box));
    if (prism_) {
        some.prism_ = std::make_shared<const ScreenPrism>(prism_->near(box));
        drop(some.prism_, prism_->overlapOf(box));
    }
    if (corridor_) {
        some.corridorParts_ = corridor_->partsNear(box);
        drop(some.corridor_, corridor_->overlapOf(box));
    }
    return some;
}

bool PointRegion::contains(Vec3d p) const {
    return !isNowhere_ && (!box_ || box_->contains(p)) && (!convex_ || convex_->contains(p)) &&
           (!polygons_ || polygons_->contains({p.x, p.y})) && (!prism_ || prism_->contains(p)) &&
           (!corridor_ || corridor_->contains({p.x, p.y}, corridorParts_));
}

} // namespace stipple
