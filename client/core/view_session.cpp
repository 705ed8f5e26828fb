#include "client/core/view_session.hpp"

#include "client/core/cloud_needs.hpp"
#include "client/core/counted_view.hpp"
#include "client/core/frame_time_controller.hpp"
#include "client/core/load_list.hpp"
#include "client/core/openings.hpp"
#include "client/core/plan_maker.hpp"
#include "client/core/session_loading.hpp"
#include "client/core/session_selection.hpp"
#include "client/core/session_view.hpp"
#include "shared/base/text.hpp"

#include <utility>

namespace stipple {

namespace {

// Per frame:  deliver → work off what was loaded and decoded → select → ask → plan
// A node's way:  bytes (LoadQueue) → NodeDecoding → CachedNode::node → DrawNode
class Session final : public ViewSession {
  public:
    Session(NodeDecoder& decoder, const SessionLimits& limits, const Now& now)
        : limits_(limits), now_(now), loading_(decoder, counters_, now), painter_(counters_) {}

    CloudId addCloud(std::unique_ptr<ByteSource> source, const std::string& name,
                     const BoxD& expected) override {
        dirty_ = true;
        return loading_.add(std::move(source), name, expected);
    }

    void open(CloudId id) override {
        auto at = loading_.clouds().find(id);
        if (at == loading_.clouds().end())
            return;
        at->second.opensAnywhere = true;
        dirty_ = true;
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

    Bytes metadataBlock(CloudId id) const override {
        auto cloud = loading_.clouds().find(id);
        return cloud == loading_.clouds().end() ? Bytes() : cloud->second.metadataBlock();
    }

    BoxD contentBounds() const override { return shownBounds(loading_.clouds()); }

    void setViewport(int width, int height) override {
        if (width <= 0 || height <= 0 || (width == view_.width && height == view_.height))
            return;
        view_.width = width;
        view_.height = height;
        dirty_ = true;
    }
    void setCamera(const Camera& camera) override {
        if (!isUsable(camera) || camera == view_.camera)
            return;
        view_.camera = camera;
        dirty_ = true;
    }
    const Camera& camera() const override { return view_.camera; }
    void setStyle(const Style& style) override {
        if (style == view_.style)
            return;
        Result<Clips> clips = Clips::make(style.clipBoxes, style.clipRegions);
        if (!clips.ok())
            return;
        (loadsAlike(style, view_.style) ? planDirty_ : dirty_) = true;
        view_.style = style;
        view_.clips = std::move(*clips);
    }
    const Style& style() const override { return view_.style; }
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
            letGoUnused();
        ++(dirty_ ? counters_.selectionsRun : counters_.selectionsSkipped);
        if (dirty_)
            selectNew();
        else if (asksMore || std::exchange(regionsChanged_, false))
            want();
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
               (view_.selection.counters.complete || loading_.anyInterrupted());
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
        updateWatched(loading_.clouds(), watched_);
        dirty_ = true;
    }

    CountedView countedView() override { return countedViewOf(view_, loading_); }

    Status askPoint(const PointIdentity& point) override {
        auto cloud = loading_.clouds().find(point.cloud);
        if (cloud == loading_.clouds().end())
            return Error{ErrorCode::invalidArgument, say("there is no cloud ", point.cloud), "", ""};
        STIPPLE_CHECK(loading_.pointQueries().ask(cloud->second, point));
        dirty_ = true; // what is to be loaded has changed
        return {};
    }
    std::vector<PointAnswer> takePointAnswers() override { return loading_.pointQueries().take(); }
    bool pointsPending() const override { return loading_.pointQueries().pending(); }

    Result<RegionScanId> scanRegion(const RegionRequest& request) override {
        auto cloud = loading_.clouds().find(request.cloud);
        if (cloud == loading_.clouds().end())
            return Error{ErrorCode::invalidArgument, say("there is no cloud ", request.cloud), "", ""};
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
        none.error = Error{ErrorCode::cancelled, say("there is no scan ", id), "", ""};
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

    void selectNew() {
        dirty_ = false;
        planDirty_ = true;
        ++frame_;
        if (updateNeeds(loading_.clouds(), loading_.cache(), view_.style, !limits_.skips.unused))
            unusedSince_ = now_();
        updateWatched(loading_.clouds(), watched_);
        view_.transform = viewTransform(view_.camera, view_.width, view_.height, contentBounds());
        std::uint64_t cloudsWaiting = chooseOpenings(loading_.clouds(), view_);
        selectNodes(view_, loading_.clouds(), limits_, limits_.frameMilliseconds > 0 ? pace_.factor() : 1);
        view_.selection.counters.complete &= !loading_.anyOpening();
        view_.selection.counters.cloudsWaiting = cloudsWaiting;
        keepSelected();
        want();
    }

    // Least recently used are then the finest first, the root last.
    void keepSelected() {
        const std::vector<SelectedNode>& nodes = view_.selection.nodes;
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node)
            loading_.cache().touch(view_.cacheKey(*node), frame_);
        if (loading_.cache().decodedBytes() > limits_.cacheBytes)
            letGoUnused();
        loading_.limitMemory(limits_, frame_);
    }

    // Attributes that the style does not use are kept for a while, and are the first to go where room is
    // short.
    void letGoUnused() {
        unusedSince_.reset();
        counters_.columnsDropped += dropUnused(loading_.clouds(), loading_.cache(), view_.style);
    }

    void want() { loading_.want(loadList(view_, loading_, limits_, !watched_.empty())); }

    // True if it differs from the last one in anything that shows.
    bool renewPlan() {
        FramePlan next = makePlan(view_, limits_, loading_, painter_, plan_);
        planDirty_ |= next.counters.nodesDelayed > 0;
        bool differs = !drawnOnce_ || !samePicture(next, plan_);
        drawnOnce_ = true;
        plan_ = std::move(next);
        return differs;
    }

    // Lets go of what the plan and the selection hold of the cloud.
    void forget(CloudId id) {
        if (std::erase_if(plan_.nodes, [&](const DrawNode& node) { return node.cloud == id; }) > 0)
            drawnOnce_ = false; // the next plan differs from the last picture
        view_.forget();
        dirty_ = true;
    }

    static constexpr std::chrono::seconds unusedLife{30}; // of attributes that the style has done with

    SessionLimits limits_;
    const Now now_;
    SessionView view_;

    FrameTimeController pace_;
    SessionCounters counters_;
    SessionLoading loading_;
    PlanPainter painter_;
    std::vector<std::string> watched_; // attributes

    bool dirty_ = true;           // a selection could come out differently
    bool planDirty_ = false;      // selected anew, or the style changed in what shows only
    bool regionsChanged_ = false; // a scan was ended
    std::uint64_t frame_ = 0;
    std::optional<std::chrono::steady_clock::time_point> unusedSince_; // something may be
    FramePlan plan_;
    bool drawnOnce_ = false;
};

} // namespace

std::unique_ptr<ViewSession> ViewSession::create(NodeDecoder& decoder, const SessionLimits& limits,
                                                 const Now& now) {
    return std::make_unique<Session>(decoder, limits, now);
}

} // namespace stipple
