#include "shared/select/cloud_filter.hpp"

#include "shared/base/text.hpp"
#include "shared/select/distance_metric.hpp"
#include "shared/select/minimum_distance.hpp"
#include "shared/select/value_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace stipple {

namespace {

Error invalid(Phrase what, Phrase advice = "") {
    return {ErrorCode::invalidArgument, std::move(what), "", std::move(advice)};
}

double worldOf(const Grid& grid, int axis, std::int64_t step) {
    return grid.toWorld({step, step, step})[axis];
}

// The least step in [low, high + 1] whose world coordinate is at least `limit` (or, `above`, larger).
std::int64_t firstStep(const Grid& grid, int axis, std::int64_t low, std::int64_t high, double limit,
                       bool above) {
    std::int64_t end = high + 1;
    while (low < end) {
        std::int64_t middle = low + (end - low) / 2;
        double world = worldOf(grid, axis, middle);
        if (above ? world > limit : world >= limit)
            end = middle;
        else
            low = middle + 1;
    }
    return low;
}

BoxI intersection(const BoxI& a, const BoxI& b) {
    BoxI both;
    for (int axis = 0; axis < 3; ++axis) {
        both.min[axis] = std::max(a.min[axis], b.min[axis]);
        both.max[axis] = std::min(a.max[axis], b.max[axis]);
    }
    return both.empty() ? BoxI{} : both;
}

// The steps of `steps` whose world positions lie in `box`.
BoxI stepsIn(const Grid& grid, const BoxI& steps, const BoxD& box) {
    BoxI in;
    for (int axis = 0; axis < 3; ++axis) {
        in.min[axis] = firstStep(grid, axis, steps.min[axis], steps.max[axis], box.min[axis], false);
        in.max[axis] = firstStep(grid, axis, steps.min[axis], steps.max[axis], box.max[axis], true) - 1;
    }
    return in.empty() ? BoxI{} : in;
}

bool contains(const BoxI& outer, const BoxI& inner) {
    return outer.contains(inner.min) && outer.contains(inner.max);
}

bool inRanges(const std::vector<ValueRange>& ranges, double value) {
    return std::any_of(ranges.begin(), ranges.end(),
                       [&](const ValueRange& r) { return value >= r.min && value <= r.max; });
}

template <class T>
void dropOutside(std::vector<std::uint32_t>& rows, const Bytes& column,
                 const std::vector<ValueRange>& ranges) {
    std::erase_if(rows, [&](std::uint32_t row) {
        return !inRanges(ranges, static_cast<double>(loadLe<T>(column.data() + row * sizeof(T))));
    });
}

void keepInRanges(std::vector<std::uint32_t>& rows, AttributeType type, const Bytes& column,
                  const std::vector<ValueRange>& ranges) {
    switch (type) {
    case AttributeType::u8:
        return dropOutside<std::uint8_t>(rows, column, ranges);
    case AttributeType::i8:
        return dropOutside<std::int8_t>(rows, column, ranges);
    case AttributeType::u16:
        return dropOutside<std::uint16_t>(rows, column, ranges);
    case AttributeType::i16:
        return dropOutside<std::int16_t>(rows, column, ranges);
    case AttributeType::u32:
        return dropOutside<std::uint32_t>(rows, column, ranges);
    case AttributeType::i32:
        return dropOutside<std::int32_t>(rows, column, ranges);
    case AttributeType::u64:
        return dropOutside<std::uint64_t>(rows, column, ranges);
    case AttributeType::i64:
        return dropOutside<std::int64_t>(rows, column, ranges);
    case AttributeType::f32:
        return dropOutside<float>(rows, column, ranges);
    case AttributeType::f64:
        return dropOutside<double>(rows, column, ranges);
    }
}

std::string lowerCase(std::string text) {
    for (char& c : text)
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return text;
}

} // namespace

std::string attributeNames(const Schema& schema) {
    std::string names;
    for (const Attribute& attribute : schema.attributes)
        names += (names.empty() ? "" : ", ") + attribute.name;
    return names;
}

Result<int> findAttribute(const Schema& schema, const std::string& name) {
    if (int exact = schema.find(name); exact >= 0)
        return exact;
    int found = -1, matches = 0;
    for (std::size_t a = 0; a < schema.attributes.size(); ++a)
        if (lowerCase(schema.attributes[a].name) == lowerCase(name)) {
            found = static_cast<int>(a);
            ++matches;
        }
    if (matches == 1)
        return found;
    return invalid(say("the cloud has no attribute \"", name, "\""),
                   schema.attributes.empty() ? say("it has positions only")
                                             : say("it has ", attributeNames(schema)));
}

Result<CloudFilter> CloudFilter::make(const CloudMetadata& metadata, const PointFilter& filter) {
    CloudFilter made(metadata);
    made.filter_ = filter;
    STIPPLE_CHECK(made.limitRegion());
    STIPPLE_CHECK(made.limitLevels());
    STIPPLE_CHECK(made.limitAttributes());
    return made;
}

Status CloudFilter::limitRegion() {
    const BoxI& bounds = metadata_->bounds;
    reach_ = bounds;
    if (filter_.box) {
        for (int axis = 0; axis < 3; ++axis) // also where a side is NaN
            if (!(filter_.box->min[axis] <= filter_.box->max[axis]))
                return invalid(say("the box is empty: its ", "xyz"[axis], " goes from ",
                                   filter_.box->min[axis], " to ", filter_.box->max[axis]),
                               say("give the smaller corner first"));
        if (!reach_.empty())
            reach_ = stepsIn(metadata_->grid, reach_, *filter_.box);
    }
    if (filter_.gridBox)
        reach_ = intersection(reach_, *filter_.gridBox);
    restricts_ = reach_ != bounds || filter_.region || filter_.convex || filter_.prism || filter_.corridor;
    auto reachOnlyInto = [&](BoxD around) {
        bool isEmpty = !(around.min.x <= around.max.x);
        if (!reach_.empty())
            reach_ = isEmpty ? BoxI{} : stepsIn(metadata_->grid, reach_, around);
    };
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (filter_.region) {
        BoxD around = filter_.region->bounds();
        around.min.z = -infinity;
        around.max.z = infinity;
        reachOnlyInto(around);
    }
    if (filter_.convex)
        reachOnlyInto(filter_.convex->bounds());
    if (filter_.corridor)
        reachOnlyInto(filter_.corridor->bounds());
    return {};
}

Status CloudFilter::limitLevels() {
    if (filter_.spacing == 0)
        return {};
    if (!(filter_.spacing > 0) || !std::isfinite(filter_.spacing))
        return invalid(say("the spacing ", filter_.spacing, " is no distance"), say("give a number above 0"));
    if (!(metadata_->spacing > 0))
        return Error{ErrorCode::unsupported, say("the cloud does not say how far apart its points are"), "",
                     say("export it without a spacing")};
    DistanceMetric metric = distanceMetric(metadata_->grid, metadata_->crs);
    metric_ = metric.weights * metric.unit;
    deepestLevel_ = 0;
    while (deepestLevel_ < maxLevel &&
           std::ldexp(metadata_->spacing, -(deepestLevel_ + 1)) >= filter_.spacing)
        ++deepestLevel_;
    restricts_ = true; // leaves are thinned
    return {};
}

Status CloudFilter::limitAttributes() {
    for (AttributeCondition& condition : filter_.conditions) {
        STIPPLE_TRY(index, findAttribute(metadata_->schema, condition.attribute));
        const auto place = static_cast<std::size_t>(index);
        if (metadata_->schema.attributes[place].components != 1)
            return invalid(
                say("\"", condition.attribute, "\" has several values a point, none to filter by"));
        if (condition.ofMeaning)
            condition.ranges = storedRanges(metadata_->schema.attributes[place], condition.ranges);
        conditionAttributes_.push_back(index);
        restricts_ = true;
        if (place >= metadata_->statistics.size())
            continue;
        // A histogram lists every value there is.
        const auto& histogram = metadata_->statistics[place].histogram;
        bool found = histogram.empty();
        for (const auto& [value, count] : histogram)
            found = found || inRanges(condition.ranges, static_cast<double>(value));
        noneHasValues_ = noneHasValues_ || !found;
    }
    return {};
}

BoxI CloudFilter::cubeOf(const NodeKey& key) const {
    Vec3i corner = metadata_->rootCube.nodeMin(key);
    std::int64_t last = (std::int64_t{1} << metadata_->rootCube.nodeBits(key.level)) - 1;
    return intersection({corner, corner + Vec3i{last, last, last}}, metadata_->bounds);
}

// A corner is where grid.toWorld() puts it, so no point of the box lies outside.
BoxD CloudFilter::worldBoxOf(const BoxI& steps) const {
    return {metadata_->grid.toWorld(steps.min), metadata_->grid.toWorld(steps.max)};
}

CloudFilter::Overlaps CloudFilter::overlapsOf(const NodeEntry& entry) const {
    BoxI cube = cubeOf(entry.key);
    BoxI common = boxOfWanted(entry);
    Overlaps overlaps;
    if (common.empty()) {
        overlaps.box = Overlap::none;
        return overlaps;
    }
    overlaps.box = contains(reach_, cube) ? Overlap::whole : Overlap::partial;
    BoxD box = worldBoxOf(common);
    if (filter_.region)
        overlaps.polygons = filter_.region->overlapOf(box);
    if (filter_.convex)
        overlaps.convex = filter_.convex->overlapOf(box);
    if (filter_.prism)
        overlaps.prism = filter_.prism->overlapOf(box);
    if (filter_.corridor)
        overlaps.corridor = filter_.corridor->overlapOf(box);
    return overlaps;
}

BoxI CloudFilter::boxOfWanted(const NodeEntry& entry) const {
    return intersection(cubeOf(entry.key), reach_);
}

bool CloudFilter::thins(const NodeEntry& entry) const {
    if (filter_.spacing == 0)
        return false;
    bool keepsDistance = metadata_->sampling == Sampling::poisson && entry.childMask != 0;
    return !keepsDistance || std::ldexp(metadata_->spacing, -entry.key.level) < filter_.spacing;
}

CloudFilter::Verdict CloudFilter::verdictOn(const NodeEntry& entry) const {
    if (wantsEverything())
        return Verdict::whole;
    if (noneHasValues_)
        return Verdict::absent;
    if (entry.key.level > deepestLevel_)
        return Verdict::finer;
    Overlap overlap = overlapsOf(entry).all();
    if (overlap == Overlap::none)
        return Verdict::outside;
    bool needsTests = overlap == Overlap::partial || !filter_.conditions.empty() || thins(entry);
    return needsTests ? Verdict::tested : Verdict::whole;
}

bool CloudFilter::wantsBelow(const NodeEntry& entry) const {
    if (wantsEverything())
        return true;
    return !noneHasValues_ && entry.key.level < deepestLevel_ && overlapsOf(entry).all() != Overlap::none;
}

void CloudFilter::keepInRegion(std::vector<std::uint32_t>& rows, const NodeEntry& entry,
                               const Overlaps& overlaps, std::span<const Vec3i> positions) const {
    auto keep = [&](Overlap overlap, auto holds) {
        if (overlap != Overlap::whole)
            std::erase_if(rows, [&](std::uint32_t row) { return !holds(positions[row]); });
    };
    auto world = [&](Vec3i p) { return metadata_->grid.toWorld(p); };
    keep(overlaps.box, [&](Vec3i p) { return reach_.contains(p); });
    keep(overlaps.convex, [&](Vec3i p) { return filter_.convex->contains(world(p)); });
    keep(overlaps.prism, [&](Vec3i p) { return filter_.prism->contains(world(p)); });
    keep(overlaps.polygons, [&](Vec3i p) {
        Vec3d at = world(p);
        return filter_.region->contains({at.x, at.y});
    });
    if (overlaps.corridor == Overlap::whole)
        return;
    std::vector<std::uint32_t> parts = filter_.corridor->partsNear(worldBoxOf(cubeOf(entry.key)));
    keep(overlaps.corridor, [&](Vec3i p) {
        Vec3d at = world(p);
        return filter_.corridor->contains({at.x, at.y}, parts);
    });
}

Result<std::vector<std::uint32_t>> CloudFilter::select(const NodeEntry& entry,
                                                       std::span<const Vec3i> positions,
                                                       std::span<const Bytes* const> tested, Dropped& dropped,
                                                       const WorkGate* gate) const {
    std::vector<std::uint32_t> distant, wanted;
    const bool isThinned = thins(entry);
    if (isThinned) {
        STIPPLE_TRY(
            kept, thinned(positions, metadata_->rootCube.nodeMin(entry.key), metric_, filter_.spacing, gate));
        distant = std::move(kept);
        dropped.bySpacing += positions.size() - distant.size();
    }
    const Overlaps overlaps = overlapsOf(entry);
    const std::size_t count = isThinned ? distant.size() : positions.size();
    STIPPLE_CHECK(inPieces(gate, count, [&](std::size_t first, std::size_t end) {
        std::vector<std::uint32_t> rows(end - first);
        if (isThinned)
            std::copy_n(distant.begin() + static_cast<std::ptrdiff_t>(first), rows.size(), rows.begin());
        else
            std::iota(rows.begin(), rows.end(), static_cast<std::uint32_t>(first));
        keepInRegion(rows, entry, overlaps, positions);
        dropped.byRegion += end - first - rows.size();

        std::size_t before = rows.size();
        for (std::size_t i = 0; i < conditionAttributes_.size(); ++i) {
            auto a = static_cast<std::size_t>(conditionAttributes_[i]);
            keepInRanges(rows, metadata_->schema.attributes[a].type, *tested[i],
                         filter_.conditions[i].ranges);
        }
        dropped.byAttribute += before - rows.size();
        wanted.insert(wanted.end(), rows.begin(), rows.end());
    }));
    return wanted;
}

Result<std::array<Bytes, 2>> CloudFilter::placesAlong(const NodeEntry& entry,
                                                      std::span<const Vec3i> positions,
                                                      const WorkGate* gate) const {
    std::array<Bytes, 2> columns{Bytes(8 * positions.size()), Bytes(8 * positions.size())};
    std::vector<std::uint32_t> parts = filter_.corridor->partsNear(worldBoxOf(cubeOf(entry.key)));
    STIPPLE_CHECK(inPieces(gate, positions.size(), [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
            constexpr double none = std::numeric_limits<double>::quiet_NaN();
            Vec3d at = metadata_->grid.toWorld(positions[i]);
            auto place = filter_.corridor->placeOf({at.x, at.y}, parts).value_or(Corridor::Place{none, none});
            storeLe(columns[0].data() + 8 * i, place.station);
            storeLe(columns[1].data() + 8 * i, place.offset);
        }
    }));
    return columns;
}

} // namespace stipple
