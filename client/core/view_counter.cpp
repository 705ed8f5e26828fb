#include "client/core/view_counter.hpp"

#include "client/core/camera.hpp"
#include "client/core/frustum.hpp"
#include "client/core/node_paint.hpp"
#include "shared/format/picture_attributes.hpp"

#include <algorithm>
#include <cmath>

namespace stipple {

namespace {

std::size_t binOf(double value, const Range& range, std::size_t bins) {
    double at = (value - range.min) / (range.max - range.min) * static_cast<double>(bins);
    return std::min(static_cast<std::size_t>(at), bins - 1);
}

Vec3d worldOf(const CountedNode& node, std::size_t point) {
    Vec3<std::uint32_t> p = positionOf(*node.node, point);
    return node.metadata->grid.toWorld({node.corner.x + p.x, node.corner.y + p.y, node.corner.z + p.z});
}

} // namespace

ViewCounter::ViewCounter(CountedView view, std::vector<HistogramRequest> requests)
    : view_(std::move(view)), requests_(std::move(requests)), moments_(requests_.size()) {
    counts_.histograms.resize(requests_.size());
    for (std::size_t i = 0; i < requests_.size(); ++i) {
        needsSecond_ |= !requests_[i].range;
        if (requests_[i].range)
            setBins(counts_.histograms[i], requests_[i], false);
    }
}

bool ViewCounter::advance(std::uint64_t points) {
    for (std::uint64_t looked = 0; looked < points;) {
        if (next_ == view_.nodes.size()) {
            if (secondPass_ || !needsSecond_)
                return true;
            startBins();
        }
        if (next_ == view_.nodes.size())
            return true; // nothing is drawn
        const CountedNode& node = view_.nodes[next_++];
        look(node);
        looked += std::max(node.points, 1u);
    }
    return next_ == view_.nodes.size() && (secondPass_ || !needsSecond_);
}

void ViewCounter::look(const CountedNode& node) {
    std::vector<std::vector<double>> of;
    bool isComplete = node.isComplete;
    for (std::size_t i = 0; i < requests_.size(); ++i) {
        bool isWanted = !secondPass_ || !requests_[i].range;
        of.push_back(isWanted ? values(node, requests_[i]) : std::vector<double>());
        isComplete &= !isWanted || !of.back().empty() || attributeOf(node, requests_[i]) < 0;
    }
    if (!secondPass_) {
        ++counts_.nodes;
        counts_.nodesMissing += !isComplete;
    }
    if (!isComplete)
        return;
    std::vector<char> visible = inView(node);
    if (!secondPass_)
        counts_.points += static_cast<std::uint64_t>(std::count(visible.begin(), visible.end(), 1));
    std::vector<Criterion> shown = criteria(node);
    for (std::size_t i = 0; i < requests_.size(); ++i)
        if (!secondPass_ || !requests_[i].range)
            count(node, i, of[i], visible, shown);
}

// -1 for elevation, and where the cloud has none of the name.
int ViewCounter::attributeOf(const CountedNode& node, const HistogramRequest& request) {
    return findAttribute(node.metadata->schema, stipple::attributeOf(request.mode, request.attribute));
}

std::vector<char> ViewCounter::inView(const CountedNode& node) const {
    ClipVerdict verdict = view_.clips.clipVerdict(node.box);
    Sight sight = Frustum(view_.view).sightOf(node.box);
    bool none = verdict.hidden || sight == Sight::outside;
    std::vector<char> visible(node.points, none ? 0 : 1);
    if (none || (sight == Sight::inside && !verdict.tested))
        return visible;
    Clips near = view_.clips.near(node.box);
    bool perspective = view_.view.projection == Projection::perspective;
    for (std::size_t i = 0; i < visible.size(); ++i) {
        Vec3d world = worldOf(node, i);
        Vec3d pixel = projectToPixels(view_.view, view_.width, view_.height, world);
        bool seen = pixel.x >= 0 && pixel.x < view_.width && pixel.y >= 0 && pixel.y < view_.height &&
                    (!perspective || pixel.z > 0);
        visible[i] = seen && !(verdict.tested && near.hides(world));
    }
    return visible;
}

std::vector<ViewCounter::Criterion> ViewCounter::criteria(const CountedNode& node) const {
    std::vector<Criterion> found;
    const Schema& schema = node.metadata->schema;
    auto add = [&](std::string_view name, const auto& shows) {
        int attribute = findAttribute(schema, name);
        if (attribute < 0)
            return; // a cloud without it shows all its points
        std::vector<double> of = values(node, {ColourMode::attribute, std::string(name), 1, {}});
        Criterion criterion{attribute, std::vector<char>(node.points, 1)};
        for (std::size_t i = 0; i < of.size(); ++i)
            criterion.passes[i] = shows(of[i], schema.attributes[static_cast<std::size_t>(attribute)]);
        found.push_back(std::move(criterion));
    };
    if (view_.style.hiddenClasses.any())
        add(attribute_names::classification, [&](double value, const Attribute&) {
            return !(value >= 0 && value <= 255 &&
                     view_.style.hiddenClasses[static_cast<std::size_t>(value)]);
        });
    for (const AttributeFilter& filter : view_.style.filters)
        add(filter.attribute,
            [&](double value, const Attribute& attribute) { return passes(filter, attribute, value); });
    return found;
}

// Of the drawn prefix; empty: the cloud has nothing of the kind.
std::vector<double> ViewCounter::values(const CountedNode& node, const HistogramRequest& request) const {
    if (request.mode == ColourMode::elevation) {
        std::vector<double> heights(node.points);
        for (std::size_t i = 0; i < heights.size(); ++i)
            heights[i] = worldOf(node, i).z;
        return heights;
    }
    const CloudMetadata& metadata = *node.metadata;
    Painter painter(view_.style, view_.clips, metadata.schema, metadata.grid, metadata.colourIs8Bit, false);
    PaintedNode painted{node.node, node.columns, node.corner, node.box, true, {}, metadata.spacing};
    std::vector<double> found = painter.attributeValues(painted, attributeOf(node, request));
    if (!found.empty())
        found.resize(node.points);
    return found;
}

void ViewCounter::count(const CountedNode& node, std::size_t at, const std::vector<double>& of,
                        const std::vector<char>& visible, const std::vector<Criterion>& criteria) {
    Histogram& histogram = counts_.histograms[at];
    Moments& moments = moments_[at];
    int own = attributeOf(node, requests_[at]);
    std::vector<int> shown = node.isMean ? pictureAttributes(*node.metadata) : std::vector<int>();
    bool isOfPicture = own >= 0 && std::find(shown.begin(), shown.end(), own) != shown.end();
    for (std::size_t i = 0; i < node.points; ++i) {
        bool counts = visible[i] && std::all_of(criteria.begin(), criteria.end(), [&](const Criterion& one) {
                          return one.attribute == own || one.passes[i];
                      });
        if (!counts)
            continue;
        if (of.empty() || of[i] != of[i]) {
            histogram.without += !secondPass_;
            continue;
        }
        if (!secondPass_) {
            double before = of[i] - moments.mean;
            if (histogram.points++ == 0)
                histogram.min = histogram.max = of[i];
            histogram.coarse += isOfPicture;
            histogram.min = std::min(histogram.min, of[i]);
            histogram.max = std::max(histogram.max, of[i]);
            moments.mean += before / static_cast<double>(histogram.points);
            moments.squares += before * (of[i] - moments.mean);
            histogram.mean = moments.mean;
            histogram.deviation = std::sqrt(moments.squares / static_cast<double>(histogram.points));
        }
        if (histogram.bins.empty())
            continue;
        if (of[i] < histogram.range.min)
            ++histogram.below;
        else if (of[i] > histogram.range.max)
            ++histogram.above;
        else
            ++histogram.bins[binOf(of[i], histogram.range, histogram.bins.size())];
    }
}

// --- bins ----------------------------------------------------------------------------------------------

void ViewCounter::startBins() {
    secondPass_ = true;
    next_ = 0;
    for (std::size_t i = 0; i < requests_.size(); ++i)
        if (!requests_[i].range && counts_.histograms[i].points > 0)
            setBins(counts_.histograms[i], requests_[i], isWhole(requests_[i]));
}

bool ViewCounter::isWhole(const HistogramRequest& request) const {
    if (request.mode == ColourMode::elevation)
        return false;
    return std::all_of(view_.nodes.begin(), view_.nodes.end(), [&](const CountedNode& node) {
        int attribute = attributeOf(node, request);
        const std::vector<Attribute>& known = node.metadata->schema.attributes;
        return attribute < 0 || stipple::isWhole(known[static_cast<std::size_t>(attribute)]);
    });
}

void ViewCounter::setBins(Histogram& histogram, const HistogramRequest& request, bool isWhole) {
    std::size_t bins = request.bins;
    histogram.range = request.range ? *request.range : Range{histogram.min, histogram.max};
    if (isWhole) {
        double values = histogram.max - histogram.min + 1;
        double each = std::ceil(values / static_cast<double>(bins));
        bins = static_cast<std::size_t>(std::ceil(values / each));
        double start = histogram.min - 0.5;
        histogram.range = {start, start + each * static_cast<double>(bins)};
    }
    if (!(histogram.range.max > histogram.range.min)) { // one value alone, in the middle of one bin
        histogram.range = {histogram.range.min - 0.5, histogram.range.min + 0.5};
        bins = 1;
    }
    histogram.bins.assign(bins, 0);
}

std::vector<std::string> attributesOf(const std::vector<HistogramRequest>& requests) {
    std::vector<std::string> names;
    for (const HistogramRequest& request : requests)
        if (std::string_view name = attributeOf(request.mode, request.attribute); !name.empty())
            names.emplace_back(name);
    return names;
}

} // namespace stipple
