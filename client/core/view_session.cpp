#include "client/core/view_session.hpp"

#include "client/core/frame_planner.hpp"
#include "client/core/frame_time_controller.hpp"
#include "client/core/frustum.hpp"
#include "client/core/load_value.hpp"
#include "client/core/plan_painter.hpp"
#include "client/core/selection.hpp"
#include "client/core/session_loading.hpp"
#include "client/core/upload_gate.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

namespace stipple {

namespace {

// Per frame:  deliver → work off what was loaded and decoded → select → ask → plan
// A node's way:  bytes (LoadQueue) → NodeDecoding → CachedNode::node → DrawNode
class Session final : public ViewSession {
  public:
    Session(NodeDecoder& decoder, const SessionLimits& limits, const Now& now)
        : limits_(limits), now_(now), loading_(decoder, counters_, now), painter_(counters_) {}

    CloudId addCloud(std::unique_ptr<ByteSource> source, const std::string& name) override {
        dirty_ = true;
        return loading_.add(std::move(source), name);
    }

    void removeCloud(CloudId id) override {
        if (loading_.remove(id))
            forget(id);
    }

    void setVisible(CloudId id, bool visible) override {
        auto at = loading_.clouds().find(id);
        if (at != loading_.clouds().end() && at->second.state.visible != visible) {
            at->second.state.visible = visible;
            dirty_ = true;
        }
    }

    std::vector<CloudState> clouds() const override {
        std::vector<CloudState> states;
        for (const auto& [id, cloud] : loading_.clouds())
            states.push_back(loading_.stateOf(cloud));
        return states;
    }

    BoxD contentBounds() const override {
        BoxD box;
        for (const auto& [id, cloud] : loading_.clouds())
            if (shown(cloud))
                box.extend(cloud.opened.metadata->worldBounds());
        return box;
    }

    void setViewport(int width, int height) override {
        if (width <= 0 || height <= 0 || (width == width_ && height == height_))
            return;
        width_ = width;
        height_ = height;
        dirty_ = true;
    }
    void setCamera(const Camera& camera) override {
        if (!isUsable(camera) || camera == camera_)
            return;
        camera_ = camera;
        dirty_ = true;
    }
    const Camera& camera() const override { return camera_; }
    void setStyle(const Style& style) override {
        Result<ClipBoxes> clips = ClipBoxes::make(style.clipBoxes);
        if (style == style_ || !clips.ok())
            return;
        (loadsAlike(style, style_) ? planDirty_ : dirty_) = true;
        style_ = style;
        clips_ = std::move(*clips);
    }
    const Style& style() const override { return style_; }
    void setLimits(const SessionLimits& limits) override {
        limits_ = limits;
        dirty_ = true;
    }
    const SessionLimits& limits() const override { return limits_; }

    void frameTook(double seconds) override {
        // It shows with the next selection: what stands still is not drawn again for it.
        pace_.frameTook(seconds, limits_.frameMilliseconds / 1000);
    }
    void refineAtRest() override { dirty_ |= pace_.reset(); }

    void load(std::chrono::milliseconds wait) override {
        loading_.deliver(dirty_ || planDirty_ ? std::chrono::milliseconds{} : wait);
        SessionLoading::Arrivals arrivals = loading_.takeArrivals();
        dirty_ |= arrivals.changed;
        for (CloudId id : arrivals.failed)
            forget(id);
        bool asksMore = loading_.regionScans().advance(loading_.clouds());
        if (unusedSince_ && now_() - *unusedSince_ > unusedLife)
            dropUnused();
        ++(dirty_ ? counters_.selectionsRun : counters_.selectionsSkipped);
        if (dirty_)
            selectAndWant();
        else if (asksMore || std::exchange(regionsChanged_, false))
            wantLoads();
        loading_.start(limits_);
    }

    bool update(std::chrono::milliseconds wait) override {
        load(wait);
        // Unless something is left to the next frame, which renewPlan() says.
        bool drawn = std::exchange(planDirty_, false) && renewPlan();
        ++(drawn ? counters_.framesDrawn : counters_.framesSkipped);
        return drawn;
    }

    const FramePlan& plan() const override { return plan_; }

    bool settled() const override {
        return !dirty_ && !planDirty_ && !regionsMustGoOn() && loading_.idle() &&
               (selection_.counters.complete || loading_.anyInterrupted());
    }

    SessionCounters counters() const override {
        SessionCounters now = counters_;
        now.cacheBytes = loading_.cache().decodedBytes();
        now.cacheBytesPeak = loading_.cache().decodedBytesPeak();
        now.compressedBytes = loading_.compressedBytes();
        now.networkBytesPerSecond = loading_.network().bytesPerSecond();
        now.networkDelaySeconds = loading_.network().delaySeconds();
        return now;
    }

    void watchAttributes(std::vector<std::string> names) override {
        if (names == watched_)
            return;
        watched_ = std::move(names);
        updateWatched();
        dirty_ = true;
    }

    CountedView countedView() override {
        CountedView counted;
        counted.view = view_;
        counted.width = width_;
        counted.height = height_;
        counted.style = style_;
        counted.clips = clips_;
        for (const SelectedNode& selected : selection_.nodes) {
            const CachedNode* cached = loading_.cache().find(cacheKey(selected));
            if (selected.drawPoints == 0 || !cached || !cached->node)
                continue;
            const CloudLoader& cloud = loading_.clouds().at(selectionIds_[selected.cloud]);
            const HierarchyNode& known = cloud.hierarchy.node(selected.node);
            const auto& metadata = cloud.opened.metadata;
            bool isMean =
                metadata->innerColour == InnerColour::mean && cloud.lacksExact(selected.node, *cached);
            counted.nodes.push_back(
                {cached->node, cached->columns(), std::min(selected.drawPoints, cached->node->pointCount),
                 cloud.hasWatched(selected.node, *cached), isMean,
                 metadata->rootCube.nodeMin(known.entry.key), known.geometry.box, metadata});
        }
        return counted;
    }

    Status askPoint(const PointIdentity& point) override {
        auto cloud = loading_.clouds().find(point.cloud);
        if (cloud == loading_.clouds().end())
            return Error{ErrorCode::invalidArgument, cat("there is no cloud ", point.cloud), "", ""};
        STIPPLE_CHECK(loading_.pointQueries().ask(cloud->second, point));
        dirty_ = true; // what is to be loaded has changed
        return {};
    }
    std::vector<PointAnswer> takePointAnswers() override { return loading_.pointQueries().take(); }
    bool pointsPending() const override { return loading_.pointQueries().pending(); }

    Result<RegionScanId> scanRegion(const RegionRequest& request) override {
        auto cloud = loading_.clouds().find(request.cloud);
        if (cloud == loading_.clouds().end())
            return Error{ErrorCode::invalidArgument, cat("there is no cloud ", request.cloud), "", ""};
        return loading_.regionScans().start(cloud->second, request);
    }
    std::vector<RegionNode> takeRegionNodes(RegionScanId id, std::size_t most) override {
        RegionScan* scan = loading_.regionScans().find(id);
        return scan ? scan->take(most) : std::vector<RegionNode>();
    }
    RegionProgress regionProgress(RegionScanId id) const override {
        if (const RegionScan* scan = loading_.regionScans().find(id))
            return scan->progress();
        RegionProgress none;
        none.error = Error{ErrorCode::cancelled, cat("there is no scan ", id), "", ""};
        return none;
    }
    void endRegionScan(RegionScanId id) override {
        loading_.regionScans().end(id);
        regionsChanged_ = true; // what is on its way for it is not wanted any more
    }
    bool regionsMustGoOn() const override { return loading_.regionScans().mustGoOn() || loading_.hasLocal(); }

    std::vector<Error> recentErrors() const override {
        return {loading_.errors().begin(), loading_.errors().end()};
    }
    std::optional<Error> passingFailure() const override { return loading_.passingFailure(); }
    void retry(std::optional<CloudId> only) override {
        loading_.retry(only);
        dirty_ = true;
    }

  private:
    bool drawsDiscs() const { return style_.shape == PointShape::disc; }
    static bool shown(const CloudLoader& cloud) { return cloud.ready() && cloud.state.visible; }
    // Whether both styles want the same nodes and attributes.
    static bool loadsAlike(const Style& a, const Style& b) {
        Style other = b;
        other.gradient = a.gradient;
        other.highlight = a.highlight;
        other.intensityRange = a.intensityRange;
        other.elevationRange = a.elevationRange;
        other.levelRange = a.levelRange;
        other.attributeRange = a.attributeRange;
        bool orientAlike = (a.shape == PointShape::disc) == (b.shape == PointShape::disc);
        return static_cast<const ColourStyle&>(a) == other && a.detail == b.detail && orientAlike;
    }

    // --- selecting and asking --------------------------------------------------------------------------

    void selectAndWant() {
        dirty_ = false;
        planDirty_ = true;
        ++frame_;
        updateNeeds();
        updateWatched();
        view_ = viewTransform(camera_, width_, height_, contentBounds());

        std::vector<SelectionCloud> inputs;
        selectionIds_.clear();
        hiddenNodes_ = 0;
        for (auto& [id, cloud] : loading_.clouds()) {
            if (!shown(cloud))
                continue;
            if (limits_.skips.hidden && hidesAll(style_, *cloud.opened.metadata)) {
                hiddenNodes_ += cloud.hierarchy.size();
                continue;
            }
            selectionIds_.push_back(id);
            inputs.push_back({&cloud.hierarchy, cloud.residency, bytesPerPoint(cloud)});
        }
        SelectionInput input;
        input.view = view_;
        input.height = height_;
        input.clouds = inputs;
        bool isContinuous = style_.detail.mode == DetailMode::continuous;
        double coarser = limits_.frameMilliseconds > 0 ? pace_.factor() : 1;
        input.pointBudget = limits_.pointBudget;
        if (!isContinuous)
            input.pointBudget =
                static_cast<std::uint64_t>(static_cast<double>(limits_.pointBudget) / (coarser * coarser));
        input.byteBudget = limits_.cacheBytes;
        input.minNodePixels = limits_.minNodePixels;
        input.weights = limits_.weights;
        input.detailPixels = isContinuous ? style_.detail.spacingPixels * coarser : 0;
        input.clips = clips_.hidesPoints() ? &clips_ : nullptr;
        input.skips = limits_.skips;
        input.wholeNodes = !limits_.techniques.prefixes;
        input.beginningsFirst = !limits_.techniques.byValue;
        selection_ = select(input);
        selection_.counters.coarserForTime = coarser;
        selection_.counters.complete &= !loading_.anyOpening();
        selection_.counters.nodesHidden += hiddenNodes_;
        findExact();

        // Least recently used are then the finest first, the root last.
        for (auto node = selection_.nodes.rbegin(); node != selection_.nodes.rend(); ++node)
            loading_.cache().touch(cacheKey(*node), frame_);
        if (loading_.cache().decodedBytes() > limits_.cacheBytes)
            dropUnused();
        loading_.limitMemory(limits_, frame_);
        wantLoads();
    }

    // What the style wants of each cloud. Where that changes, what is drawable does too.
    void updateNeeds() {
        for (auto& [id, cloud] : loading_.clouds()) {
            AttributeNeeds needs;
            if (cloud.ready())
                needs = limits_.skips.unused ? needsOf(style_, *cloud.opened.metadata)
                                             : needsOfAll(style_, *cloud.opened.metadata);
            if (needs == cloud.needs)
                continue;
            cloud.needs = std::move(needs);
            unusedSince_ = now_();
            for (std::uint32_t node = 0; node < cloud.residency.size(); ++node)
                cloud.updateResidency(node, loading_.cache().find({id, node}));
        }
    }

    void updateWatched() {
        ColourStyle looking; // that needs these attributes and nothing else
        looking.colourMode = ColourMode::elevation;
        for (const std::string& name : watched_)
            looking.filters.push_back({name, -HUGE_VAL, HUGE_VAL});
        for (auto& [id, cloud] : loading_.clouds())
            cloud.watched = cloud.ready() ? needsOf(looking, *cloud.opened.metadata) : AttributeNeeds();
    }

    std::uint32_t bytesPerPoint(const CloudLoader& cloud) const {
        const CloudMetadata& metadata = *cloud.opened.metadata;
        bool wide = metadata.rootCube.bits > positionWordBits;
        bool painted = style_.colourMode != ColourMode::rgb || cloud.needs.exactBlock >= 0 ||
                       !style_.clipBoxes.empty() || hidesPoints(style_);
        bool oriented = drawsDiscs() && normalAttributes(metadata.schema);
        return 12u + (wide ? 4u : 0u) + (painted ? 4u : 0u) + (oriented ? 4u : 0u) +
               columnBytes(cloud.needs, metadata) + (cloud.needs.exactBlock >= 0 ? 4u : 0u);
    }

    // Attributes that the style does not use are kept for a while, and are the first to go where room is
    // short.
    void dropUnused() {
        unusedSince_.reset();
        loading_.cache().visit([&](CacheKey key, CachedNode& cached) {
            auto cloud = loading_.clouds().find(key.cloud);
            if (cloud == loading_.clouds().end())
                return false;
            const AttributeNeeds &needs = cloud->second.needs, &watched = cloud->second.watched;
            auto isNeeded = [](const AttributeNeeds& by, int block) {
                return block == by.exactBlock ||
                       std::find(by.blocks.begin(), by.blocks.end(), block) != by.blocks.end();
            };
            bool packed = !drawsDiscs() && std::exchange(cached.normals, nullptr) != nullptr;
            auto dropped = std::erase_if(cached.blocks, [&](const CachedBlock& one) {
                return !one.decoding && !isNeeded(needs, one.block) && !isNeeded(watched, one.block);
            });
            counters_.columnsDropped += dropped;
            return dropped > 0 || packed;
        });
    }

    // Which of the selected nodes have nothing coarse left to show: they and their children, as far as they
    // are in view, are drawn whole. Their exact colours are wanted.
    void findExact() {
        exact_.clear();
        std::set<std::pair<std::uint32_t, std::uint32_t>> whole;
        auto isWhole = [&](const SelectedNode& selected) {
            const CloudLoader& cloud = loading_.clouds().at(selectionIds_[selected.cloud]);
            return cloud.needs.exactBlock >= 0 &&
                   selected.drawPoints == cloud.hierarchy.node(selected.node).entry.pointCount;
        };
        for (const SelectedNode& selected : selection_.nodes)
            if (isWhole(selected))
                whole.emplace(selected.cloud, selected.node);
        if (whole.empty())
            return;
        Frustum frustum(view_);
        for (const auto& [cloudIndex, node] : whole) {
            const CloudLoader& cloud = loading_.clouds().at(selectionIds_[cloudIndex]);
            const HierarchyNode& known = cloud.hierarchy.node(node);
            auto exactBlock = static_cast<std::size_t>(cloud.needs.exactBlock);
            if (known.childrenState != ChildrenState::known || known.entry.attributeBytes[exactBlock] == 0)
                continue;
            bool coarse = std::any_of(
                known.children.begin(), known.children.end(), [&, &index = cloudIndex](int child) {
                    if (child < 0 || whole.contains({index, static_cast<std::uint32_t>(child)}))
                        return false;
                    const BoxD& box = cloud.hierarchy.node(static_cast<std::size_t>(child)).geometry.box;
                    return frustum.intersects(box) && !clips_.clipVerdict(box).hidden;
                });
            if (!coarse)
                exact_.emplace(cloudIndex, node);
        }
    }

    template <class Node>
    CacheKey cacheKey(const Node& node) const {
        return {selectionIds_[node.cloud], node.node};
    }

    // What to ask for of a node, and what it is worth.
    struct NodeLoad {
        double valuePerByte = 0;
        std::vector<LoadItem> items;
    };
    NodeLoad nodeLoad(const WantedNode& wanted, std::uint64_t pieceBytes) {
        CloudLoader& cloud = loading_.clouds().at(selectionIds_[wanted.cloud]);
        const CachedNode* cached = loading_.cache().find(cacheKey(wanted));
        const NodeEntry& entry = cloud.hierarchy.node(wanted.node).entry;
        int have = cached ? cached->strataFetched : 0, strata = std::max(have, wanted.strata);
        if (limits_.techniques.byValue && limits_.techniques.prefixes)
            strata = nextPiece(entry, have, strata, pieceBytes);
        NodeLoad load;
        if (auto item = cloud.pictureItem(wanted.node, strata, cached))
            load.items.push_back(std::move(*item));
        cloud.addBlockItems(wanted.node, cached, load.items);
        std::uint64_t bytes = 1;
        for (const LoadItem& item : load.items)
            bytes += item.range.size;
        std::uint32_t from = have < strata ? strataPrefixPoints(entry.pointCount, have) : 0;
        load.valuePerByte = loadValue(view_, height_, cloud.hierarchy, wanted.node, from,
                                      strataPrefixPoints(entry.pointCount, strata)) /
                            static_cast<double>(bytes);
        return load;
    }

    // The fewest further strata that are worth a request.
    static int nextPiece(const NodeEntry& entry, int have, int wanted, std::uint64_t pieceBytes) {
        std::uint64_t before = entry.strataRange(have).size;
        for (int strata = have + 1; strata < wanted; ++strata)
            if (entry.strataRange(strata).size - before >= pieceBytes)
                return strata;
        return wanted;
    }

    void wantLoads() {
        std::vector<LoadItem> items;
        for (auto& [id, cloud] : loading_.clouds())
            if (auto item = cloud.openingItem())
                items.push_back(std::move(*item));
        // Somebody waits for an answer about a point.
        for (auto& [id, cloud] : loading_.clouds())
            for (LoadItem& item : loading_.pointQueries().items(cloud))
                items.push_back(std::move(item));
        // Chunks are small, and what they hide may matter more than any node that is known.
        for (const WantedChunk& chunk : selection_.chunks)
            items.push_back(loading_.clouds().at(selectionIds_[chunk.cloud]).chunkItem(chunk.node));
        std::uint64_t pieceBytes = loading_.loadLimits(limits_).pieceBytes;
        std::vector<NodeLoad> loads;
        for (const WantedNode& wanted : selection_.loads)
            loads.push_back(nodeLoad(wanted, pieceBytes));
        if (limits_.techniques.byValue)
            std::stable_sort(loads.begin(), loads.end(), [](const NodeLoad& a, const NodeLoad& b) {
                return a.valuePerByte > b.valuePerByte;
            });
        for (NodeLoad& load : loads)
            std::move(load.items.begin(), load.items.end(), std::back_inserter(items));
        for (const auto& [cloudIndex, node] : exact_) {
            CloudLoader& cloud = loading_.clouds().at(selectionIds_[cloudIndex]);
            const CachedNode* cached = loading_.cache().find({selectionIds_[cloudIndex], node});
            if (auto item = cloud.blockItem(node, cloud.needs.exactBlock, cached);
                item && !cloud.residency[node].failed)
                items.push_back(std::move(*item));
        }
        if (!watched_.empty())
            for (const SelectedNode& selected : selection_.nodes)
                loading_.clouds()
                    .at(selectionIds_[selected.cloud])
                    .addWatchedItems(selected.node, loading_.cache().find(cacheKey(selected)), items);
        // Behind all that the picture needs, which may want the same chunks.
        std::set<LoadKey> chunks;
        for (const LoadItem& item : items)
            if (item.key.kind == LoadKind::chunk)
                chunks.insert(item.key);
        for (LoadItem& item : loading_.regionScans().items(loading_.clouds(), loading_.cache()))
            if (item.key.kind != LoadKind::chunk || chunks.insert(item.key).second)
                items.push_back(std::move(item));
        loading_.want(std::move(items));
    }

    // --- the plan --------------------------------------------------------------------------------------

    // True if it differs from the last one in anything that shows.
    bool renewPlan() {
        FramePlan next;
        next.width = width_;
        next.height = height_;
        next.view = view_;
        std::vector<std::shared_ptr<const CloudMetadata>> metadata;
        for (CloudId id : selectionIds_)
            metadata.push_back(loading_.clouds().at(id).opened.metadata);
        next.gpuBytes = limits_.gpuBytes;
        next.style = resolvedStyle(style_, metadata);
        painter_.setStyle(next.style);
        UploadGate uploads(plan_, limits_.uploadBytes);
        next.detailPixels = selection_.counters.detailPixels;
        next.counters = selection_.counters;
        next.counters.passesRun = plan_.counters.passesRun;
        next.counters.passesSkipped = plan_.counters.passesSkipped;
        for (const SelectedNode& selected : selection_.nodes) {
            if (selected.drawPoints == 0)
                continue;
            CloudLoader& cloud = loading_.clouds().at(selectionIds_[selected.cloud]);
            CacheKey key = cacheKey(selected);
            CachedNode* cached = loading_.cache().find(key);
            bool exact =
                exact_.contains({selected.cloud, selected.node}) && cached->hasBlock(cloud.needs.exactBlock);
            bool painted = painter_.paint(cloud, selected.node, exact, *cached);
            bool oriented = drawsDiscs() && PlanPainter::orient(cloud, *cached);
            if (painted || oriented)
                loading_.cache().recount(key);
            if (limits_.skips.hidden && cached->paint && cached->paint->hidden == cached->node->pointCount) {
                ++next.counters.nodesHidden;
                --next.counters.nodesDrawn;
                next.counters.pointsDrawn -= selected.drawPoints;
                continue;
            }
            auto [isNow, before] = uploads.judge(cloud.state.id, *cached->node);
            std::uint32_t points = selected.drawPoints;
            if (!isNow) {
                points = before ? std::min(points, before->node->pointCount) : 0;
                ++next.counters.nodesDelayed;
                next.counters.pointsDrawn -= selected.drawPoints - points;
            }
            if (points == 0) {
                --next.counters.nodesDrawn;
                continue;
            }
            next.nodes.push_back(
                planNode(isNow ? cached->node : before->node, points, *cloud.opened.metadata, view_.eye));
            next.nodes.back().cloud = cloud.state.id;
            next.nodes.back().density = cloud.hierarchy.densityOf(selected.node);
            next.nodes.back().paint = isNow ? cached->paint : before->paint;
            if (drawsDiscs())
                next.nodes.back().normals = isNow ? cached->normals : before->normals;
            next.counters.pointsHidden += cached->paint ? cached->paint->hidden : 0;
            next.counters.nodesExact += exact;
        }
        next.awaited = awaitedNodes();
        if (next.counters.nodesDelayed > 0) {
            planDirty_ = true;
            next.counters.complete = false;
        }
        bool differs = !drawnOnce_ || !samePicture(next, plan_);
        drawnOnce_ = true;
        plan_ = std::move(next);
        return differs;
    }

    // Selected nodes that are not here, or with too little of what is to show of them to count as their
    // level; and the children that a chunk on its way is to bring.
    std::vector<AwaitedNode> awaitedNodes() const {
        std::vector<AwaitedNode> awaited;
        if (!style_.growsWhileLoading)
            return awaited;
        for (const SelectedNode& selected : selection_.nodes) {
            const CloudLoader& cloud = loading_.clouds().at(selectionIds_[selected.cloud]);
            const NodeEntry& entry = cloud.hierarchy.node(selected.node).entry;
            std::uint32_t level =
                (entry.pointCount + 2) / 3; // so many points are nearer to it than to the one above
            if (selected.drawPoints < level && selected.points >= level &&
                !cloud.residency[selected.node].failed)
                awaited.push_back({cloud.state.id, entry.key});
        }
        for (const WantedChunk& chunk : selection_.chunks) {
            const CloudLoader& cloud = loading_.clouds().at(selectionIds_[chunk.cloud]);
            for (int child = 0; child < 8; ++child)
                awaited.push_back({cloud.state.id, cloud.hierarchy.node(chunk.node).entry.key.child(child)});
        }
        return awaited;
    }

    static bool samePicture(const FramePlan& a, const FramePlan& b) {
        auto sameNode = [](const DrawNode& x, const DrawNode& y) {
            return x.node->id == y.node->id && x.colourId() == y.colourId() && x.normals == y.normals &&
                   x.pointCount == y.pointCount;
        };
        return a.width == b.width && a.height == b.height && a.view == b.view && a.style == b.style &&
               a.detailPixels == b.detailPixels && a.awaited == b.awaited &&
               std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), b.nodes.end(), sameNode);
    }

    // Lets go of what the plan and the selection hold of the cloud.
    void forget(CloudId id) {
        if (std::erase_if(plan_.nodes, [&](const DrawNode& node) { return node.cloud == id; }) > 0)
            drawnOnce_ = false; // the next plan differs from the last picture
        selection_ = {};
        exact_.clear();
        selectionIds_.clear();
        dirty_ = true;
    }

    static constexpr std::chrono::seconds unusedLife{30}; // of attributes that the style has done with

    SessionLimits limits_;
    const Now now_;
    Camera camera_;
    Style style_;
    int width_ = 1280, height_ = 720;

    FrameTimeController pace_;
    SessionCounters counters_;
    SessionLoading loading_;
    PlanPainter painter_;
    ClipBoxes clips_;                  // of style_
    std::vector<std::string> watched_; // attributes

    bool dirty_ = true;           // a selection could come out differently
    bool planDirty_ = false;      // selected anew, or the style changed in what shows only
    bool regionsChanged_ = false; // a scan was ended
    std::uint64_t frame_ = 0;
    std::optional<std::chrono::steady_clock::time_point> unusedSince_; // something may be
    ViewTransform view_;
    Selection selection_;
    std::vector<CloudId> selectionIds_; // of selection_'s cloud indices
    std::uint64_t hiddenNodes_ = 0;     // known, of clouds of which the style hides every point
    // Nodes (cloud index, node) of which and below which nothing that shows is coarse.
    std::set<std::pair<std::uint32_t, std::uint32_t>> exact_;
    FramePlan plan_;
    bool drawnOnce_ = false;
};

} // namespace

std::unique_ptr<ViewSession> ViewSession::create(NodeDecoder& decoder, const SessionLimits& limits,
                                                 const Now& now) {
    return std::make_unique<Session>(decoder, limits, now);
}

} // namespace stipple
