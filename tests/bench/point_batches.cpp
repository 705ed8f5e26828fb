#include "tests/bench/point_batches.hpp"

#include "client/core/frustum.hpp"
#include "client/render/drawn_octree.hpp"

#include <algorithm>
#include <cmath>

namespace stipple {
namespace {

// Updates that a list outlives the last one that drew its node.
constexpr std::uint64_t keptUpdates = 30;

int octantOf(const Vec3<std::uint32_t>& p, int nodeBits) {
    if (nodeBits == 0)
        return 0;
    int bit = nodeBits - 1;
    return static_cast<int>((p.x >> bit & 1u) | (p.y >> bit & 1u) << 1 | (p.z >> bit & 1u) << 2);
}

// Where a list's points come from: the parent's list, brought into the node's bounds, then its own.
struct Sources {
    const ResidentNode* parent = nullptr;
    std::uint32_t parentFirst = 0, parentCount = 0;
    const DrawNode* own = nullptr;
    int nodeBits = 0;

    std::uint32_t size() const { return parentCount + (own ? own->pointCount : 0); }
    bool coloured() const {
        return (parentCount > 0 && !parent->colourWords.empty()) || (own && !own->colourWords().empty());
    }

    template <class Visit>
    void visit(const Visit& visit) const {
        std::uint32_t mask = (1u << nodeBits) - 1;
        for (std::uint32_t i = parentFirst; i < parentFirst + parentCount; ++i) {
            Vec3<std::uint32_t> p = positionOf(*parent, i);
            visit(Vec3<std::uint32_t>{p.x & mask, p.y & mask, p.z & mask},
                  parent->colourWords.empty() ? plainColourWord : parent->colourWords[i]);
        }
        if (!own)
            return;
        const std::vector<std::uint32_t>& colours = own->colourWords();
        for (std::uint32_t i = 0; i < own->pointCount; ++i)
            visit(positionOf(*own->node, i), colours.empty() ? plainColourWord : colours[i]);
    }
};

// Algorithm 1: how many each octant has, then each point to its place.
std::shared_ptr<const ResidentNode> listFrom(const Sources& sources, const NodeKey& key,
                                             std::array<std::uint32_t, 9>& octants) {
    auto list = std::make_shared<ResidentNode>();
    list->id = nextResidentNodeId();
    list->key = key;
    list->nodeBits = sources.nodeBits;
    int shift = list->positionShift = std::max(0, sources.nodeBits - positionWordBits);
    list->pointCount = list->totalPoints = sources.size();
    octants = {};
    sources.visit([&](const Vec3<std::uint32_t>& p, std::uint32_t) {
        ++octants[static_cast<std::size_t>(octantOf(p, sources.nodeBits)) + 1];
    });
    for (std::size_t i = 1; i < 9; ++i)
        octants[i] += octants[i - 1];
    std::array<std::uint32_t, 9> next = octants;
    list->positionWords.resize(2 * std::size_t{list->pointCount});
    list->positionLowWords.resize(shift > 0 ? list->pointCount : 0);
    list->colourWords.resize(sources.coloured() ? list->pointCount : 0);
    std::uint32_t lowMask = (1u << shift) - 1;
    sources.visit([&](const Vec3<std::uint32_t>& p, std::uint32_t colour) {
        std::size_t at = next[static_cast<std::size_t>(octantOf(p, sources.nodeBits))]++;
        list->positionWords[2 * at] = packPositionWord0(p.x >> shift, p.y >> shift);
        list->positionWords[2 * at + 1] = packPositionWord1(p.y >> shift, p.z >> shift);
        if (shift > 0)
            list->positionLowWords[at] = packPositionLow(p.x & lowMask, p.y & lowMask, p.z & lowMask);
        if (!list->colourWords.empty())
            list->colourWords[at] = colour;
    });
    return list;
}

// The child of a node as the camera sees it, without points.
DrawNode childOf(const DrawNode& node, int nodeBits, int octant) {
    DrawNode child;
    child.scale = node.scale;
    child.spacing = node.spacing;
    child.cloud = node.cloud;
    std::int64_t side = std::int64_t{1} << nodeBits; // of the child
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double whole = std::floor(node.cameraOffset[axis]);
        std::int64_t cell =
            node.cameraCell[axis] + static_cast<std::int64_t>(whole) - ((octant >> axis & 1) != 0 ? side : 0);
        std::int64_t inside = std::clamp<std::int64_t>(cell, 0, std::min<std::int64_t>(side, INT32_MAX));
        child.cameraCell[axis] = static_cast<std::int32_t>(inside);
        child.cameraOffset[axis] = static_cast<double>(cell - inside) + (node.cameraOffset[axis] - whole);
        child.cameraFraction[axis] = static_cast<float>(child.cameraOffset[axis]);
    }
    return child;
}

// Of an octant of a node, relative to the eye.
BoxD octantBox(const DrawNode& node, int octant) {
    double half = std::ldexp(0.5, node.node->nodeBits);
    BoxD box;
    for (int axis = 0; axis < 3; ++axis) {
        auto i = static_cast<std::size_t>(axis);
        double from = ((octant >> axis & 1) != 0 ? half : 0) - node.cameraCell[i] - node.cameraOffset[i];
        box.min[axis] = from * node.scale[axis];
        box.max[axis] = (from + half) * node.scale[axis];
    }
    return box;
}

Frustum frustumAtOrigin(ViewTransform view) {
    view.eye = {};
    return Frustum(view);
}

} // namespace

void PointBatches::update(const FramePlan& plan) {
    ++updates_;
    counters_ = {.bytes = counters_.bytes};
    plan_.width = plan.width;
    plan_.height = plan.height;
    plan_.view = plan.view;
    plan_.style = plan.style;
    plan_.nodes.clear();
    runs_.clear();

    DrawnOctree tree = drawnOctree(plan);
    std::vector<const DrawNode*> own(tree.words.size(), nullptr);
    for (std::size_t i = 0; i < plan.nodes.size(); ++i)
        if (plan.nodes[i].node && plan.nodes[i].pointCount > 0)
            own[tree.places[i]] = &plan.nodes[i];
    // Parents come before children.
    std::vector<Step> steps(tree.words.size());
    std::vector<std::pair<std::uint32_t, int>> parents(tree.words.size(), {0, -1}); // word, octant
    Frustum frustum = frustumAtOrigin(plan.view);
    for (std::uint32_t at = 0; at < tree.words.size(); ++at) {
        auto [parent, octant] = parents[at];
        if (octant < 0 && !own[at])
            continue; // there are no drawn nodes
        take(octant < 0 ? nullptr : &steps[parent], octant, own[at], steps[at]);
        std::uint32_t child = tree.words[at] >> firstChildShift, children = tree.words[at] & 255u;
        for (int i = 0; i < 8; ++i)
            if ((children >> i & 1u) != 0)
                parents[child++] = {at, i};
        addToPlan(steps[at], children, frustum);
    }
    forget();
}

void PointBatches::take(const Step* parent, int octant, const DrawNode* own, Step& step) {
    if (own) {
        step.node = *own;
        step.place = {own->cloud, own->node->key};
        counters_.ownPoints += own->pointCount;
    } else {
        step.node = childOf(parent->node, parent->node.node->nodeBits - 1, octant);
        step.place = {parent->place.cloud, parent->place.key.child(octant)};
    }
    step.list = &listOf(step, own, parent, octant);
    step.node.node = step.list->points;
    step.node.paint = nullptr;
    step.node.pointCount = step.list->points->pointCount;
    counters_.listPoints += step.node.pointCount;
}

const PointBatches::List& PointBatches::listOf(const Step& step, const DrawNode* own, const Step* parent,
                                               int octant) {
    Origin origin{own ? own->node->id : 0, own ? own->colourId() : 0, parent ? parent->list->points->id : 0,
                  own ? own->pointCount : 0};
    List& list = lists_[step.place];
    list.lastUpdate = updates_;
    if (list.points && list.origin == origin)
        return list;
    Sources sources;
    sources.own = own;
    sources.nodeBits = own ? own->node->nodeBits : parent->node.node->nodeBits - 1;
    if (parent) {
        auto at = static_cast<std::size_t>(octant);
        sources.parent = parent->list->points.get();
        sources.parentFirst = parent->list->octants[at];
        sources.parentCount = parent->list->octants[at + 1] - sources.parentFirst;
    }
    if (list.points)
        counters_.bytes -= list.points->sizeBytes();
    list.points = listFrom(sources, step.place.key, list.octants);
    list.origin = origin;
    counters_.bytes += list.points->sizeBytes();
    counters_.listsMade += 1;
    counters_.pointsMade += sources.size();
    return list;
}

void PointBatches::addToPlan(const Step& step, std::uint32_t children, const Frustum& frustum) {
    const auto& octants = step.list->octants;
    std::vector<BatchRun> runs;
    for (int octant = 0; octant < 8; ++octant) {
        auto at = static_cast<std::size_t>(octant);
        BatchRun run{octants[at], octants[at + 1] - octants[at]};
        bool inherited = (children >> octant & 1u) != 0;
        if (run.count == 0 || inherited ||
            (leaveOutUnseen_ && !frustum.intersects(octantBox(step.node, octant))))
            continue;
        counters_.vertices += run.count;
        if (!runs.empty() && runs.back().first + runs.back().count == run.first)
            runs.back().count += run.count;
        else
            runs.push_back(run);
    }
    if (runs.empty())
        return;
    counters_.drawCalls += runs.size();
    counters_.listCalls += 1;
    counters_.listVertices += step.node.pointCount;
    plan_.nodes.push_back(step.node);
    runs_.push_back(std::move(runs));
}

void PointBatches::forget() {
    std::erase_if(lists_, [&](const auto& entry) {
        bool old = entry.second.lastUpdate + keptUpdates < updates_;
        if (old)
            counters_.bytes -= entry.second.points->sizeBytes();
        return old;
    });
}

FramePlan planOfRuns(const PointBatches& batches) {
    FramePlan plan = batches.plan();
    for (std::size_t n = 0; n < plan.nodes.size(); ++n) {
        DrawNode& node = plan.nodes[n];
        const ResidentNode& list = *node.node;
        auto drawn = std::make_shared<ResidentNode>();
        drawn->id = nextResidentNodeId();
        drawn->key = list.key;
        drawn->nodeBits = list.nodeBits;
        drawn->positionShift = list.positionShift;
        for (const BatchRun& run : batches.runs(n)) {
            auto append = [&](const std::vector<std::uint32_t>& from, std::vector<std::uint32_t>& to,
                              std::ptrdiff_t words) {
                if (!from.empty())
                    to.insert(to.end(), from.begin() + words * run.first,
                              from.begin() + words * (run.first + run.count));
            };
            append(list.positionWords, drawn->positionWords, 2);
            append(list.positionLowWords, drawn->positionLowWords, 1);
            append(list.colourWords, drawn->colourWords, 1);
            drawn->pointCount += run.count;
        }
        drawn->totalPoints = node.pointCount = drawn->pointCount;
        node.node = std::move(drawn);
        node.cloud = static_cast<std::uint32_t>(n);
    }
    return plan;
}

} // namespace stipple
