#include "client/core/view_session.hpp"

#include "client/core/cloud_loader.hpp"
#include "client/core/frame_planner.hpp"
#include "client/core/load_queue.hpp"
#include "client/core/node_cache.hpp"
#include "client/core/selection.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <deque>
#include <map>
#include <thread>

namespace stipple {

namespace {

constexpr int maxDecodeAttempts = 2;
// With several things to wait for, each is waited for this long in turn.
constexpr std::chrono::milliseconds waitSlice{2};

// Per frame:  deliver → work off what was loaded and decoded → select → ask → plan
// A node's way:  bytes (LoadQueue) → CachedNode::compressed → decoder → CachedNode::node → DrawNode
class Session final : public ViewSession {
  public:
    Session(NodeDecoder& decoder, const SessionLimits& limits, Now now)
        : decoder_(decoder), limits_(limits), now_(now), queue_(counters_) {}

    ~Session() override {
        *alive_ = false;
        for (auto& [id, cloud] : clouds_)
            queue_.removeSource(id);
    }

    CloudId addCloud(std::unique_ptr<ByteSource> source, const std::string& name) override {
        CloudId id = ++lastCloud_;
        CloudLoader& cloud = clouds_[id];
        cloud.state.id = id;
        cloud.state.name = name;
        cloud.source = std::move(source);
        cloud.format = makeStippleNodeSource();
        queue_.addSource(id, *cloud.source);
        cloud.advanceOpening();
        dirty_ = true;
        return id;
    }

    void removeCloud(CloudId id) override {
        if (clouds_.count(id) == 0)
            return;
        release(id);
        clouds_.erase(id);
        dirty_ = true;
    }

    void setVisible(CloudId id, bool visible) override {
        auto at = clouds_.find(id);
        if (at != clouds_.end() && at->second.state.visible != visible) {
            at->second.state.visible = visible;
            dirty_ = true;
        }
    }

    std::vector<CloudState> clouds() const override {
        std::vector<CloudState> states;
        for (const auto& [id, cloud] : clouds_)
            states.push_back(cloud.state);
        return states;
    }

    BoxD contentBounds() const override {
        BoxD box;
        for (const auto& [id, cloud] : clouds_)
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
        if (style == style_)
            return;
        // Only another colour mode can change what has to be loaded.
        (style.colourMode == style_.colourMode ? planDirty_ : dirty_) = true;
        style_ = style;
    }
    const Style& style() const override { return style_; }
    void setLimits(const SessionLimits& limits) override {
        limits_ = limits;
        dirty_ = true;
    }
    const SessionLimits& limits() const override { return limits_; }

    bool update(std::chrono::milliseconds wait) override {
        deliver(wait);
        workOffArrivals();
        bool selected = dirty_;
        if (dirty_)
            selectAndWant();
        ++(selected ? counters_.selectionsRun : counters_.selectionsSkipped);
        queue_.start({limits_.requestsInFlight, limits_.bytesInFlight, limits_.mergeGapBytes,
                      limits_.mergedRequestBytes},
                     bytesDecoding_, now_());
        bool drawn = (selected || planDirty_) && renewPlan();
        planDirty_ = false;
        ++(drawn ? counters_.framesDrawn : counters_.framesSkipped);
        return drawn;
    }

    const FramePlan& plan() const override { return plan_; }

    bool settled() const override {
        return !dirty_ && !planDirty_ && !anyOpening() && local_.empty() && decoded_.empty() &&
               decodesPending_ == 0 && queue_.idle() && selection_.counters.complete;
    }

    SessionCounters counters() const override {
        SessionCounters now = counters_;
        now.cacheBytes = cache_.sizeBytes();
        now.cacheBytesPeak = cache_.peakBytes();
        return now;
    }

    std::vector<Error> recentErrors() const override { return {errors_.begin(), errors_.end()}; }

  private:
    struct Decoded {
        CacheKey key;
        int strata; // 0: the intensities
        std::uint64_t bytes;
        Result<ResidentNode> node;
    };

    static bool shown(const CloudLoader& cloud) { return cloud.ready() && cloud.state.visible; }

    bool anyOpening() const {
        return std::any_of(clouds_.begin(), clouds_.end(),
                           [](const auto& cloud) { return cloud.second.opening(); });
    }

    // --- waiting ---------------------------------------------------------------------------------------

    int pumpAll(std::chrono::milliseconds wait) {
        int delivered = 0;
        for (auto& [id, cloud] : clouds_)
            if (queue_.awaits(id))
                delivered += cloud.source->pump(delivered == 0 ? wait : std::chrono::milliseconds{});
        if (decodesPending_ > 0)
            delivered += decoder_.pump(delivered == 0 ? wait : std::chrono::milliseconds{});
        return delivered;
    }

    bool haveWork() const {
        return dirty_ || planDirty_ || !local_.empty() || !decoded_.empty() || queue_.hasArrivals();
    }

    void deliver(std::chrono::milliseconds wait) {
        pumpAll({});
        auto end = std::chrono::steady_clock::now() + wait;
        while (wait.count() > 0 && !haveWork()) {
            auto left =
                std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
            bool pausing = queue_.nextRetry() != LoadQueue::Clock::time_point::max();
            if (left.count() <= 0 || (pausing && queue_.nextRetry() <= now_()))
                return;
            if (queue_.requestsInFlight() > 0 || decodesPending_ > 0)
                pumpAll(std::min(left, awaited() == 1 ? left : waitSlice));
            else if (pausing)
                std::this_thread::sleep_for(std::min(left, waitSlice));
            else
                return; // nothing is on its way
        }
    }

    // Things that pump() could wait for.
    std::ptrdiff_t awaited() const {
        return (decodesPending_ > 0 ? 1 : 0) +
               std::count_if(clouds_.begin(), clouds_.end(),
                             [&](const auto& c) { return queue_.awaits(c.first); });
    }

    // --- arrivals --------------------------------------------------------------------------------------

    void workOffArrivals() {
        std::vector<Loaded> loaded = std::move(local_);
        local_.clear();
        for (Loaded& more : queue_.take(now_()))
            loaded.push_back(std::move(more));
        for (Loaded& one : loaded)
            takeLoaded(one);
        // An inline decoder has answered by now.
        std::deque<Decoded> decoded = std::move(decoded_);
        decoded_.clear();
        for (Decoded& one : decoded)
            takeDecoded(one);
    }

    void takeLoaded(Loaded& loaded) {
        auto at = clouds_.find(loaded.item.key.cloud);
        if (at == clouds_.end() || at->second.state.stage == CloudStage::failed)
            return;
        CloudLoader& cloud = at->second;
        auto node = static_cast<std::uint32_t>(loaded.item.key.id);
        dirty_ = true;
        if (!loaded.bytes.ok()) {
            takeFailure(cloud, loaded.item, loaded.bytes.error());
            return;
        }
        switch (loaded.item.key.kind) {
        case LoadKind::opening:
            cloud.fetched.add(loaded.item.range.offset, std::move(*loaded.bytes));
            cloud.advanceOpening();
            if (cloud.state.stage == CloudStage::failed)
                failCloud(cloud, cloud.state.error);
            break;
        case LoadKind::chunk: {
            Status added = cloud.addChunk(node, *loaded.bytes);
            if (!added.ok())
                record(cloud, added.error().at("chunk below node " + keyText(cloud, node)));
            else
                ++counters_.chunksLoaded;
            break;
        }
        case LoadKind::picture:
            takePicture(cloud, node, loaded);
            break;
        case LoadKind::intensity:
            decodeIntensity(cloud, node, std::move(*loaded.bytes));
            break;
        }
    }

    void takeFailure(CloudLoader& cloud, const LoadItem& item, const Error& error) {
        auto node = static_cast<std::uint32_t>(item.key.id);
        if (error.code == ErrorCode::changed || item.key.kind == LoadKind::opening) {
            cloud.fail(error);
            failCloud(cloud, cloud.state.error);
            return;
        }
        if (item.key.kind == LoadKind::chunk)
            cloud.hierarchy.markChildrenFailed(node);
        else
            cloud.residency[node].failed = true;
        record(cloud, error.at("node " + keyText(cloud, node)));
    }

    void takePicture(CloudLoader& cloud, std::uint32_t node, Loaded& loaded) {
        CacheKey key{cloud.state.id, node};
        CachedNode& cached = cache_.obtain(key);
        if (cached.strataFetched != loaded.item.fromStrata)
            return; // what these bytes continue was dropped in between
        if (cached.compressed.empty())
            cached.compressed = std::move(*loaded.bytes);
        else
            cached.compressed.insert(cached.compressed.end(), loaded.bytes->begin(), loaded.bytes->end());
        cached.strataFetched = loaded.item.strata;
        cache_.recount(key);
        if (!cached.decodingPicture)
            decodePicture(cloud, node, cached);
    }

    void decodePicture(CloudLoader& cloud, std::uint32_t node, CachedNode& cached) {
        DecodeJob job;
        job.entry = cloud.hierarchy.node(node).entry;
        job.strata = cached.strataFetched;
        job.picture = cached.compressed;
        cached.decodingPicture = true;
        cached.strataDecoding = job.strata;
        decode(cloud, node, std::move(job));
    }

    void decodeIntensity(CloudLoader& cloud, std::uint32_t node, Bytes bytes) {
        DecodeJob job;
        job.entry = cloud.hierarchy.node(node).entry;
        job.strata = 0;
        job.wantsIntensity = true;
        job.intensity = std::move(bytes);
        cache_.obtain({cloud.state.id, node}).decodingIntensity = true;
        decode(cloud, node, std::move(job));
    }

    void decode(CloudLoader& cloud, std::uint32_t node, DecodeJob job) {
        job.cloud = cloud.state.id;
        job.metadata = cloud.opened.metadata;
        CacheKey key{cloud.state.id, node};
        int strata = job.strata;
        std::uint64_t bytes = job.picture.size() + job.intensity.size();
        bytesDecoding_ += bytes;
        ++decodesPending_;
        decoder_.decode(std::move(job),
                        [this, alive = alive_, key, strata, bytes](Result<ResidentNode> answer) {
                            if (*alive)
                                decoded_.push_back({key, strata, bytes, std::move(answer)});
                        });
    }

    void takeDecoded(Decoded& decoded) {
        --decodesPending_;
        bytesDecoding_ -= decoded.bytes;
        auto at = clouds_.find(decoded.key.cloud);
        if (at == clouds_.end() || !at->second.ready())
            return;
        CloudLoader& cloud = at->second;
        CachedNode* cached = cache_.find(decoded.key);
        if (!cached)
            return; // evicted meanwhile
        dirty_ = true;
        (decoded.strata > 0 ? cached->decodingPicture : cached->decodingIntensity) = false;
        if (!decoded.node.ok())
            takeDecodeFailure(cloud, decoded, *cached);
        else if (decoded.strata > 0)
            takeDecodedPicture(cloud, decoded, *cached);
        else
            takeDecodedIntensity(decoded, *cached);
        cache_.recount(decoded.key);
        cloud.updateResidency(decoded.key.node, cached);
    }

    void takeDecodeFailure(CloudLoader& cloud, const Decoded& decoded, CachedNode& cached) {
        if (decoded.strata > 0) {
            // The bytes may have been damaged on their way: once more from the start.
            cached.compressed = {};
            cached.strataFetched = 0;
        }
        int failures = ++cloud.decodeFailures[decoded.key.node];
        if (failures < maxDecodeAttempts)
            return;
        cloud.residency[decoded.key.node].failed = true;
        record(cloud, decoded.node.error());
    }

    void takeDecodedPicture(CloudLoader& cloud, Decoded& decoded, CachedNode& cached) {
        ++counters_.nodesDecoded;
        counters_.pointsDecoded += decoded.node->pointCount;
        ResidentNode node = std::move(*decoded.node);
        if (cached.intensity)
            node = withIntensity(node, *cached.intensity);
        bool complete = node.pointCount == node.totalPoints;
        cached.node = std::make_shared<const ResidentNode>(std::move(node));
        if (complete) {
            cached.strataFetched = strataCount; // strata may be empty
            cached.compressed = {};
            cached.intensity.reset();
        } else if (cached.strataFetched > decoded.strata) {
            decodePicture(cloud, decoded.key.node, cached);
        }
    }

    void takeDecodedIntensity(Decoded& decoded, CachedNode& cached) {
        auto intensity = std::make_shared<std::vector<float>>(std::move(decoded.node->intensity));
        bool complete = cached.node && cached.node->pointCount == cached.node->totalPoints;
        if (cached.node)
            cached.node = std::make_shared<const ResidentNode>(withIntensity(*cached.node, *intensity));
        if (!complete)
            cached.intensity = std::move(intensity);
    }

    // --- selecting and asking --------------------------------------------------------------------------

    void selectAndWant() {
        dirty_ = false;
        ++frame_;
        updateNeeds();
        view_ = viewTransform(camera_, width_, height_, contentBounds());

        std::vector<SelectionCloud> inputs;
        selectionIds_.clear();
        for (auto& [id, cloud] : clouds_) {
            if (!shown(cloud))
                continue;
            selectionIds_.push_back(id);
            inputs.push_back({&cloud.hierarchy, cloud.residency, bytesPerPoint(cloud)});
        }
        SelectionInput input;
        input.view = view_;
        input.height = height_;
        input.clouds = inputs;
        input.pointBudget = limits_.pointBudget;
        input.byteBudget = limits_.cacheBytes;
        input.minNodePixels = limits_.minNodePixels;
        selection_ = select(input);
        selection_.counters.complete &= !anyOpening();

        // Least recently used are then the finest first, the root last.
        for (auto node = selection_.nodes.rbegin(); node != selection_.nodes.rend(); ++node)
            cache_.touch(cacheKey(*node), frame_);
        for (CacheKey key : cache_.evict(limits_.cacheBytes, frame_)) {
            ++counters_.nodesEvicted;
            if (auto cloud = clouds_.find(key.cloud); cloud != clouds_.end())
                cloud->second.updateResidency(key.node, nullptr);
        }
        wantLoads();
    }

    // What the style wants of each cloud. Where that changes, what is drawable does too.
    void updateNeeds() {
        for (auto& [id, cloud] : clouds_) {
            bool needs =
                cloud.ready() && style_.colourMode == ColourMode::intensity && cloud.intensityBlock >= 0;
            if (needs == cloud.needsIntensity)
                continue;
            cloud.needsIntensity = needs;
            for (std::uint32_t node = 0; node < cloud.residency.size(); ++node)
                cloud.updateResidency(node, cache_.find({id, node}));
        }
    }

    static std::uint32_t bytesPerPoint(const CloudLoader& cloud) {
        bool wide = cloud.opened.metadata->rootCube.bits > positionWordBits;
        return 12u + (wide ? 4u : 0u) + (cloud.needsIntensity ? 4u : 0u);
    }

    template <class Node>
    CacheKey cacheKey(const Node& node) const {
        return {selectionIds_[node.cloud], node.node};
    }

    void wantLoads() {
        std::vector<LoadItem> items;
        auto add = [&](LoadItem item) {
            if (item.range.size > 0)
                items.push_back(std::move(item));
            else // all its bytes are here
                local_.push_back({item, std::move(item.head)});
        };
        for (auto& [id, cloud] : clouds_)
            if (auto item = cloud.openingItem())
                items.push_back(std::move(*item));
        // Chunks are small, and what they hide may matter more than any node that is known.
        for (const WantedChunk& chunk : selection_.chunks)
            add(clouds_.at(selectionIds_[chunk.cloud]).chunkItem(chunk.node));
        for (const WantedNode& wanted : selection_.loads) {
            CloudLoader& cloud = clouds_.at(selectionIds_[wanted.cloud]);
            const CachedNode* cached = cache_.find(cacheKey(wanted));
            if (auto item = cloud.pictureItem(wanted.node, wanted.strata, cached))
                add(std::move(*item));
            if (auto item = cloud.intensityItem(wanted.node, cached))
                add(std::move(*item));
        }
        queue_.want(std::move(items));
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
            metadata.push_back(clouds_.at(id).opened.metadata);
        next.style = resolvedStyle(style_, metadata);
        next.counters = selection_.counters;
        next.counters.passesRun = plan_.counters.passesRun;
        next.counters.passesSkipped = plan_.counters.passesSkipped;
        planClouds_.clear();
        for (const SelectedNode& selected : selection_.nodes) {
            if (selected.drawPoints == 0)
                continue;
            CloudLoader& cloud = clouds_.at(selectionIds_[selected.cloud]);
            const CachedNode* cached = cache_.find(cacheKey(selected));
            next.nodes.push_back(
                planNode(cached->node, selected.drawPoints, *cloud.opened.metadata, view_.eye));
            planClouds_.push_back(cloud.state.id);
        }
        bool differs = !drawnOnce_ || !samePicture(next, plan_);
        drawnOnce_ = true;
        plan_ = std::move(next);
        return differs;
    }

    static bool samePicture(const FramePlan& a, const FramePlan& b) {
        auto sameNode = [](const DrawNode& x, const DrawNode& y) {
            return x.node->id == y.node->id && x.pointCount == y.pointCount;
        };
        return a.width == b.width && a.height == b.height && a.view == b.view && a.style == b.style &&
               std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), b.nodes.end(), sameNode);
    }

    // --- failing and letting go ------------------------------------------------------------------------

    static std::string keyText(const CloudLoader& cloud, std::uint32_t node) {
        return cloud.hierarchy.node(node).entry.key.text();
    }

    void record(const CloudLoader& cloud, const Error& error) { remember(cloud.placed(error)); }

    void remember(const Error& error) {
        errors_.push_back(error);
        if (errors_.size() > maxRecentErrors)
            errors_.pop_front();
    }

    void failCloud(CloudLoader& cloud, const Error& error) {
        remember(error);
        release(cloud.state.id);
    }

    // Cancels what is on its way and frees all that is held of the cloud, in the plan too.
    void release(CloudId id) {
        queue_.removeSource(id);
        cache_.eraseCloud(id);
        std::erase_if(local_, [&](const Loaded& loaded) { return loaded.item.key.cloud == id; });
        std::size_t kept = 0;
        for (std::size_t i = 0; i < plan_.nodes.size(); ++i)
            if (planClouds_[i] != id) {
                planClouds_[kept] = planClouds_[i];
                plan_.nodes[kept++] = plan_.nodes[i];
            }
        if (kept < plan_.nodes.size())
            drawnOnce_ = false; // the next plan differs from the last picture
        plan_.nodes.resize(kept);
        planClouds_.resize(kept);
        selection_ = {};
        selectionIds_.clear();
        dirty_ = true;
    }

    NodeDecoder& decoder_;
    SessionLimits limits_;
    Now now_;
    Camera camera_;
    Style style_;
    int width_ = 1280, height_ = 720;

    SessionCounters counters_;
    NodeCache cache_;
    LoadQueue queue_;
    std::map<CloudId, CloudLoader> clouds_;
    CloudId lastCloud_ = 0;

    std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
    std::vector<Loaded> local_;   // wanted, and here without a request
    std::deque<Decoded> decoded_; // answered by the decoder, not taken in yet
    std::size_t decodesPending_ = 0;
    std::uint64_t bytesDecoding_ = 0;
    std::deque<Error> errors_;

    bool dirty_ = true;      // a selection could come out differently
    bool planDirty_ = false; // the style changed in what shows only
    std::uint64_t frame_ = 0;
    ViewTransform view_;
    Selection selection_;
    std::vector<CloudId> selectionIds_; // of selection_'s cloud indices
    FramePlan plan_;
    std::vector<CloudId> planClouds_; // parallel to plan_.nodes
    bool drawnOnce_ = false;
};

} // namespace

std::unique_ptr<ViewSession> ViewSession::create(NodeDecoder& decoder, const SessionLimits& limits, Now now) {
    return std::make_unique<Session>(decoder, limits, now);
}

} // namespace stipple
