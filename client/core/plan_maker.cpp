#include "client/core/plan_maker.hpp"

#include "client/core/frame_planner.hpp"
#include "client/core/upload_gate.hpp"

#include <algorithm>
#include <utility>

namespace stipple {

namespace {

class PlanMaker {
  public:
    PlanMaker(const SessionView& view, const SessionLimits& limits, SessionLoading& loading,
              PlanPainter& painter, const FramePlan& last)
        : view_(view), limits_(limits), loading_(loading), painter_(painter), last_(last),
          uploads_(last, limits.uploadBytes) {}

    FramePlan make() {
        describe();
        for (const SelectedNode& selected : view_.selection.nodes)
            if (selected.drawPoints > 0)
                addNode(selected);
        if (view_.style.growsWhileLoading)
            addAwaited();
        if (plan_.counters.nodesDelayed > 0)
            plan_.counters.complete = false;
        return std::move(plan_);
    }

  private:
    void describe() {
        plan_.width = view_.width;
        plan_.height = view_.height;
        plan_.view = view_.transform;
        std::vector<std::shared_ptr<const CloudMetadata>> metadata;
        for (CloudId id : view_.clouds)
            metadata.push_back(loading_.clouds().at(id).opened.metadata);
        plan_.gpuBytes = limits_.gpuBytes;
        plan_.style = resolvedStyle(view_.style, metadata);
        painter_.setStyle(plan_.style);
        plan_.counters = view_.selection.counters;
        plan_.detailPixels = plan_.counters.detailPixels;
        plan_.counters.passesRun = last_.counters.passesRun;
        plan_.counters.passesSkipped = last_.counters.passesSkipped;
    }

    void addNode(const SelectedNode& selected) {
        CloudLoader& cloud = view_.cloudOf(loading_.clouds(), selected);
        CacheKey key = view_.cacheKey(selected);
        CachedNode* cached = loading_.cache().find(key);
        bool exact =
            view_.exact.contains({selected.cloud, selected.node}) && cached->hasBlock(cloud.needs.exactBlock);
        bool painted = painter_.paint(cloud, selected.node, exact, *cached);
        bool oriented = view_.drawsDiscs() && PlanPainter::orient(cloud, *cached);
        if (painted || oriented)
            loading_.cache().recount(key);
        FrameCounters& counters = plan_.counters;
        if (limits_.skips.hidden && cached->paint && cached->paint->hidden == cached->node->pointCount) {
            ++counters.nodesHidden;
            --counters.nodesDrawn;
            counters.pointsDrawn -= selected.drawPoints;
            return;
        }
        auto [isNow, before] = uploads_.judge(cloud.state.id, *cached->node);
        std::uint32_t points = selected.drawPoints;
        if (!isNow) {
            points = before ? std::min(points, before->node->pointCount) : 0;
            ++counters.nodesDelayed;
            counters.pointsDrawn -= selected.drawPoints - points;
        }
        if (points == 0) {
            --counters.nodesDrawn;
            return;
        }
        DrawNode draw = planNode(isNow ? cached->node : before->node, points, *cloud.opened.metadata,
                                 view_.transform.eye);
        draw.cloud = cloud.state.id;
        draw.density = cloud.hierarchy.densityOf(selected.node);
        draw.paint = isNow ? cached->paint : before->paint;
        if (view_.drawsDiscs())
            draw.normals = isNow ? cached->normals : before->normals;
        plan_.nodes.push_back(std::move(draw));
        counters.pointsHidden += cached->paint ? cached->paint->hidden : 0;
        counters.nodesExact += exact;
    }

    // Selected nodes that are not here, or with too little of what is to show of them to count as their
    // level; and the children that a chunk on its way is to bring.
    void addAwaited() {
        for (const SelectedNode& selected : view_.selection.nodes) {
            const CloudLoader& cloud = view_.cloudOf(loading_.clouds(), selected);
            const NodeEntry& entry = cloud.hierarchy.node(selected.node).entry;
            std::uint32_t level =
                (entry.pointCount + 2) / 3; // so many points are nearer to it than to the one above
            if (selected.drawPoints < level && selected.points >= level &&
                !cloud.residency[selected.node].failed)
                plan_.awaited.push_back({cloud.state.id, entry.key});
        }
        for (const WantedChunk& chunk : view_.selection.chunks) {
            const CloudLoader& cloud = view_.cloudOf(loading_.clouds(), chunk);
            for (int child = 0; child < 8; ++child)
                plan_.awaited.push_back(
                    {cloud.state.id, cloud.hierarchy.node(chunk.node).entry.key.child(child)});
        }
    }

    const SessionView& view_;
    const SessionLimits& limits_;
    SessionLoading& loading_;
    PlanPainter& painter_;
    const FramePlan& last_;
    UploadGate uploads_;
    FramePlan plan_;
};

} // namespace

FramePlan makePlan(const SessionView& view, const SessionLimits& limits, SessionLoading& loading,
                   PlanPainter& painter, const FramePlan& last) {
    return PlanMaker(view, limits, loading, painter, last).make();
}

bool samePicture(const FramePlan& a, const FramePlan& b) {
    auto sameNode = [](const DrawNode& x, const DrawNode& y) {
        return x.node->id == y.node->id && x.colourId() == y.colourId() && x.normals == y.normals &&
               x.pointCount == y.pointCount;
    };
    return a.width == b.width && a.height == b.height && a.view == b.view && a.style == b.style &&
           a.detailPixels == b.detailPixels && a.awaited == b.awaited &&
           std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), b.nodes.end(), sameNode);
}

} // namespace stipple
