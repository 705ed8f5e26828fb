#include "client/core/session_loading.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

namespace stipple {

namespace {

// With several things to wait for, each is waited for this long in turn.
constexpr std::chrono::milliseconds waitSlice{2};

// Decoded at a time of what is here already; the rest is wanted again when some of it is done.
constexpr std::uint64_t mostLocalBytes = 4 << 20;

// A file that is another one now: nothing of its cloud can be used any more.
bool isFatal(const Error& error) {
    return error.code == ErrorCode::changed;
}

std::string keyText(const CloudLoader& cloud, std::uint32_t node) {
    return cloud.hierarchy.node(node).entry.key.text();
}

} // namespace

SessionLoading::SessionLoading(NodeDecoder& decoder, SessionCounters& counters, const ViewSession::Now& now)
    : counters_(counters), now_(now),
      queue_(counters, static_cast<std::uint64_t>(now().time_since_epoch().count())), decoder_(decoder),
      decoding_(decoder, cache_, counters), pointQueries_(decoder) {}

SessionLoading::~SessionLoading() {
    for (auto& [id, cloud] : clouds_)
        queue_.removeSource(id);
}

CloudId SessionLoading::add(std::unique_ptr<ByteSource> source, const std::string& name,
                            const BoxD& expected) {
    CloudId id = ++lastCloud_;
    CloudLoader& cloud = clouds_[id];
    cloud.state.id = id;
    cloud.state.name = name;
    cloud.source = std::move(source);
    cloud.format = makeStippleNodeSource();
    cloud.kept = &kept_;
    cloud.state.expected = std::isfinite(length(expected.max - expected.min)) ? expected : BoxD();
    cloud.isToOpen = cloud.state.expected.empty();
    queue_.addSource(id, *cloud.source);
    cloud.advanceOpening();
    return id;
}

void SessionLoading::retry(std::optional<CloudId> only) {
    for (auto& [id, cloud] : clouds_) {
        if (only && *only != id)
            continue;
        queue_.retry(id);
        cloud.state.interrupted.reset();
        cloud.takeUpLost();
        if (cloud.state.stage != CloudStage::failed)
            continue;
        cloud.source->forgetVersion(); // whatever is there by now; a source of one version opens that again
        open(cloud);
    }
}

CloudState SessionLoading::stateOf(const CloudLoader& cloud) const {
    CloudState state = cloud.state;
    if (state.stage == CloudStage::opening && !cloud.opening())
        state.stage = CloudStage::waiting;
    if (auto failure = queue_.passingFailure(state.id)) {
        state.retrying = cloud.placed(*failure);
        auto next = queue_.nextRetry(state.id);
        if (next != LoadQueue::Clock::time_point::max()) // else it is on its way
            state.retrySeconds = std::max(0.0, std::chrono::duration<double>(next - now_()).count());
    }
    state.nodesMissing = cloud.lostNodes.size();
    state.chunksMissing = cloud.lostChunks.size();
    state.caution = cloud.source->caution();
    return state;
}

// From the beginning; nothing is held or on its way.
void SessionLoading::open(CloudLoader& cloud) {
    queue_.addSource(cloud.state.id, *cloud.source);
    cloud.reset();
    cloud.advanceOpening();
}

bool SessionLoading::remove(CloudId id) {
    if (clouds_.count(id) == 0)
        return false;
    release(id);
    clouds_.erase(id);
    return true;
}

// --- waiting -------------------------------------------------------------------------------------------

int SessionLoading::pumpAll(std::chrono::milliseconds wait) {
    int delivered = 0;
    for (auto& [id, cloud] : clouds_)
        if (queue_.awaits(id))
            delivered += cloud.source->pump(delivered == 0 ? wait : std::chrono::milliseconds{});
    if (isDecoding())
        delivered += decoder_.pump(delivered == 0 ? wait : std::chrono::milliseconds{});
    return delivered;
}

bool SessionLoading::hasArrivals() const {
    return !local_.empty() || decoding_.hasAnswers() || queue_.hasArrivals();
}

// Things that pump() could wait for.
std::ptrdiff_t SessionLoading::awaited() const {
    return (isDecoding() ? 1 : 0) + std::count_if(clouds_.begin(), clouds_.end(), [&](const auto& cloud) {
               return queue_.awaits(cloud.first);
           });
}

void SessionLoading::deliver(std::chrono::milliseconds wait) {
    pumpAll({});
    auto end = std::chrono::steady_clock::now() + wait;
    while (wait.count() > 0 && !hasArrivals()) {
        auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
        bool pausing = queue_.nextRetry() != LoadQueue::Clock::time_point::max();
        if (left.count() <= 0 || (pausing && queue_.nextRetry() <= now_()))
            return;
        if (queue_.requestsInFlight() > 0 || isDecoding())
            pumpAll(std::min(left, awaited() == 1 ? left : waitSlice));
        else if (pausing)
            std::this_thread::sleep_for(std::min(left, waitSlice));
        else
            return; // nothing is on its way
    }
}

bool SessionLoading::anyOpening() const {
    return std::any_of(clouds_.begin(), clouds_.end(),
                       [](const auto& cloud) { return cloud.second.opening(); });
}

bool SessionLoading::anyInterrupted() const {
    return std::any_of(clouds_.begin(), clouds_.end(),
                       [](const auto& cloud) { return cloud.second.state.interrupted.has_value(); });
}

bool SessionLoading::idle() const {
    return !anyOpening() && local_.empty() && !decoding_.hasAnswers() && !isDecoding() && queue_.idle();
}

// --- asking --------------------------------------------------------------------------------------------

void SessionLoading::want(std::vector<LoadItem> items) {
    auto here = std::stable_partition(items.begin(), items.end(), [](const LoadItem& item) {
        return item.range.size > 0 || item.key.kind == LoadKind::opening;
    });
    std::uint64_t working = decoding_.bytesPending();
    for (auto item = here; item != items.end() && working < mostLocalBytes; ++item) {
        Bytes bytes = std::move(item->head);
        working += bytes.size();
        counters_.bytesReused += bytes.size();
        local_.push_back({std::move(*item), std::move(bytes)});
    }
    items.erase(here, items.end());
    queue_.want(std::move(items));
}

LoadLimits SessionLoading::loadLimits(const SessionLimits& limits) const {
    LoadLimits most;
    most.requests = limits.requestsInFlight;
    most.bytes = limits.bytesInFlight;
    most.mergeGapBytes = limits.mergeGapBytes;
    most.mergedRequestBytes = limits.mergedRequestBytes;
    most.mergesNodes = limits.techniques.merging;
    return limits.techniques.adaptive ? queue_.fitted(most) : unmeasuredLimits(most);
}

void SessionLoading::start(const SessionLimits& limits) {
    queue_.start(loadLimits(limits), decoding_.bytesPending(), now_());
}

// --- arrivals ------------------------------------------------------------------------------------------

SessionLoading::Arrivals SessionLoading::takeArrivals() {
    Arrivals arrivals;
    std::vector<Loaded> loaded = std::move(local_);
    local_.clear();
    for (Loaded& more : queue_.take(now_()))
        loaded.push_back(std::move(more));
    for (LoadedGap& gap : queue_.takeGaps())
        kept_.add(gap.cloud, gap.offset, std::move(gap.bytes));
    for (Loaded& one : loaded)
        takeLoaded(one, arrivals);
    // An inline decoder has answered by now.
    NodeDecoding::Taken taken = decoding_.takeAnswers(clouds_);
    arrivals.changed |= taken.changed;
    for (const Error& error : taken.errors)
        remember(error);
    return arrivals;
}

void SessionLoading::takeLoaded(Loaded& loaded, Arrivals& arrivals) {
    auto at = clouds_.find(loaded.item.key.cloud);
    bool isStale = std::find(arrivals.failed.begin(), arrivals.failed.end(), loaded.item.key.cloud) !=
                   arrivals.failed.end(); // of a file that was let go a moment ago
    if (at == clouds_.end() || at->second.state.stage == CloudStage::failed || isStale)
        return;
    CloudLoader& cloud = at->second;
    auto node = static_cast<std::uint32_t>(loaded.item.key.id);
    if (loaded.item.key.kind == LoadKind::region && (loaded.bytes.ok() || !isFatal(loaded.bytes.error()))) {
        takeRegion(cloud, loaded);
        return;
    }
    arrivals.changed = true;
    if (loaded.item.key.kind == LoadKind::points && (loaded.bytes.ok() || !isFatal(loaded.bytes.error()))) {
        pointQueries_.takeLoaded(cloud, node, std::move(loaded.bytes));
        return;
    }
    if (!loaded.bytes.ok()) {
        takeFailure(cloud, loaded.item, loaded.bytes.error(), arrivals);
        return;
    }
    switch (loaded.item.key.kind) {
    case LoadKind::opening:
        cloud.fetched.add(loaded.item.range.offset, std::move(*loaded.bytes));
        cloud.advanceOpening();
        if (cloud.state.stage == CloudStage::failed)
            failed(cloud, arrivals);
        break;
    case LoadKind::chunk:
        takeChunk(cloud, node, *loaded.bytes);
        break;
    case LoadKind::picture:
        decoding_.takePicture(cloud, node, loaded);
        break;
    case LoadKind::attributes:
        decoding_.takeBlock(cloud, node, loaded.item.key.block, std::move(*loaded.bytes));
        break;
    case LoadKind::points:
    case LoadKind::region:
        break; // taken above
    }
}

// Kept as what came along in gaps is, so that the picture does not ask for it once more.
void SessionLoading::takeRegion(CloudLoader& cloud, Loaded& loaded) {
    const ByteRange& range = loaded.item.range;
    if (loaded.bytes.ok() && range.size > 0 && loaded.bytes->size() >= range.size)
        kept_.add(cloud.state.id, range.offset,
                  Bytes(loaded.bytes->end() - static_cast<std::ptrdiff_t>(range.size), loaded.bytes->end()));
    regionScans_.takeLoaded(cloud, loaded.item, std::move(loaded.bytes));
}

// The bytes may have been damaged on their way: once more.
void SessionLoading::takeChunk(CloudLoader& cloud, std::uint32_t node, const Bytes& bytes) {
    Status added = cloud.addChunk(node, bytes);
    if (added.ok()) {
        ++counters_.chunksLoaded;
    } else if (!cloud.damagedChunks.insert(node).second) {
        cloud.loseChunk(node, added.error().at("chunk below node " + keyText(cloud, node)));
        remember(*cloud.state.lastLoss);
    }
}

void SessionLoading::takeFailure(CloudLoader& cloud, const LoadItem& item, const Error& error,
                                 Arrivals& arrivals) {
    auto node = static_cast<std::uint32_t>(item.key.id);
    if (error.code == ErrorCode::changed && cloud.mayReload(now_()) && cloud.source->forgetVersion())
        return reload(cloud, arrivals);
    if (isFatal(error) || item.key.kind == LoadKind::opening) {
        cloud.fail(error);
        failed(cloud, arrivals);
        return;
    }
    if (queue_.stopped(cloud.state.id)) {
        if (!cloud.state.interrupted)
            remember(cloud.placed(error));
        cloud.state.interrupted = cloud.placed(error);
        return;
    }
    if (item.key.kind == LoadKind::chunk)
        cloud.loseChunk(node, error.at("node " + keyText(cloud, node)));
    else
        cloud.loseNode(node, error.at("node " + keyText(cloud, node)));
    remember(*cloud.state.lastLoss);
}

void SessionLoading::reload(CloudLoader& cloud, Arrivals& arrivals) {
    release(cloud.state.id);
    arrivals.failed.push_back(cloud.state.id);
    open(cloud);
    cloud.reloadedAt = now_();
    ++cloud.state.reloads;
    ++counters_.cloudsReloaded;
}

void SessionLoading::limitMemory(const SessionLimits& limits, std::uint64_t frame) {
    for (NodeCache::Evicted& gone : cache_.evict(limits.cacheBytes, frame)) {
        ++counters_.nodesEvicted;
        auto cloud = clouds_.find(gone.key.cloud);
        if (cloud == clouds_.end())
            continue;
        cloud->second.updateResidency(gone.key.node, nullptr);
        kept_.add(gone.key.cloud, cloud->second.hierarchy.node(gone.key.node).entry.offsetBytes,
                  std::move(gone.compressed));
    }
    std::uint64_t refining = cache_.compressedBytes();
    kept_.limit(limits.compressedBytes - std::min(limits.compressedBytes, refining));
    if (refining > limits.compressedBytes)
        cache_.dropCompressed(limits.compressedBytes, frame);
}

std::uint64_t SessionLoading::compressedBytes() const {
    std::uint64_t bytes = kept_.sizeBytes() + cache_.compressedBytes();
    for (const auto& [id, cloud] : clouds_)
        bytes += cloud.fetched.sizeBytes();
    return bytes;
}

// --- failing and letting go ----------------------------------------------------------------------------

void SessionLoading::failed(CloudLoader& cloud, Arrivals& arrivals) {
    remember(cloud.state.error);
    release(cloud.state.id);
    arrivals.failed.push_back(cloud.state.id);
}

// Cancels what is on its way and frees all that is held of the cloud.
void SessionLoading::release(CloudId id) {
    queue_.removeSource(id);
    cache_.eraseCloud(id);
    kept_.eraseCloud(id);
    pointQueries_.cancel(id);
    regionScans_.fail(id, {ErrorCode::cancelled, say("the cloud was closed, or its file replaced"), "", ""});
    std::erase_if(local_, [&](const Loaded& loaded) { return loaded.item.key.cloud == id; });
}

void SessionLoading::remember(const Error& error) {
    errors_.push_back(error);
    if (errors_.size() > maxRecentErrors)
        errors_.pop_front();
}

} // namespace stipple
