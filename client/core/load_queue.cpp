#include "client/core/load_queue.hpp"

#include "client/core/load_merging.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <set>

namespace stipple {

struct LoadQueue::Request {
    std::uint32_t cloud = 0;
    ByteSource::RequestId id = 0;
    ByteRange range;
    std::vector<LoadItem> items;
    bool cancelled = false;
    bool isLetFinish = false; // nothing of it is wanted
    bool hasBegun = false;
    TransferEstimate::Sent sent;
};

namespace {

// How often an item is asked for. A disk or network may recover; an answer that ends early may have been cut
// on its way; a file that contradicts itself or changed will not.
int mostAttempts(ErrorCode code) {
    switch (code) {
    case ErrorCode::networkFailed:
        return LoadQueue::maxNetworkAttempts;
    case ErrorCode::ioFailed:
    case ErrorCode::cancelled:
        return LoadQueue::maxAttempts;
    case ErrorCode::truncated:
        return LoadQueue::maxCutAttempts;
    default:
        return 1;
    }
}

// Of a source, whatever it is asked for: who asks again gets the same answer, until somebody does something.
bool isRefusal(ErrorCode code) {
    return code == ErrorCode::accessDenied || code == ErrorCode::unsupported;
}

} // namespace

LoadQueue::Clock::duration LoadQueue::pauseAfter(int attempts) const {
    // SplitMix64 (Steele, Lea, Flood 2014)
    std::uint64_t random = seed_ + static_cast<std::uint64_t>(attempts) * 0x9E3779B97F4A7C15u;
    random = (random ^ (random >> 30)) * 0xBF58476D1CE4E5B9u;
    random = (random ^ (random >> 27)) * 0x94D049BB133111EBu;
    random ^= random >> 31;
    int milliseconds = 250 << (2 * std::clamp(attempts - 1, 0, 2));
    return std::chrono::milliseconds(milliseconds * 3 / 4 +
                                     static_cast<int>(random % static_cast<unsigned>(milliseconds / 2 + 1)));
}

LoadQueue::LoadQueue(SessionCounters& counters, std::uint64_t seed)
    : counters_(counters), seed_(seed), self_(std::make_shared<LoadQueue*>(this)) {}

LoadQueue::~LoadQueue() {
    *self_ = nullptr; // completions that come later find nobody
}

void LoadQueue::addSource(std::uint32_t cloud, ByteSource& source) {
    sources_[cloud] = {};
    sources_[cloud].bytes = &source;
}

void LoadQueue::removeSource(std::uint32_t cloud) {
    std::erase_if(waiting_, [&](const LoadItem& item) { return item.key.cloud == cloud; });
    std::erase_if(failures_, [&](const auto& failure) { return failure.first.cloud == cloud; });
    for (auto& [id, request] : requests_)
        if (request.cloud == cloud)
            cancel(request);
    // Whether the source answers a cancelled request or not, nothing is waited for.
    std::erase_if(arrivals_, [&](const Arrival& arrival) {
        auto at = requests_.find(arrival.request);
        return at != requests_.end() && at->second.cloud == cloud;
    });
    std::erase_if(requests_, [&](const auto& request) { return request.second.cloud == cloud; });
    sources_.erase(cloud);
}

void LoadQueue::want(std::vector<LoadItem> items) {
    std::set<LoadKey> wanted;
    for (const LoadItem& item : items)
        wanted.insert(item.key);
    for (auto& [id, request] : requests_) {
        bool needed = std::any_of(request.items.begin(), request.items.end(),
                                  [&](const LoadItem& item) { return wanted.contains(item.key); });
        if (needed || request.cancelled)
            continue;
        if (!isNearlyHere(request)) {
            cancel(request);
        } else if (!request.isLetFinish) {
            request.isLetFinish = true;
            ++counters_.requestsLetFinish;
        }
    }
    std::erase_if(items, [&](const LoadItem& item) {
        auto source = sources_.find(item.key.cloud);
        return travelling_.contains(item.key) || source == sources_.end() || source->second.isStopped;
    });
    waiting_ = std::move(items);
}

void LoadQueue::cancel(Request& request) {
    if (request.cancelled)
        return;
    request.cancelled = true;
    ++counters_.requestsCancelled;
    --requestsInFlight_;
    bytesInFlight_ -= request.range.size;
    for (const LoadItem& item : request.items)
        travelling_.erase(item.key);
    if (auto source = sources_.find(request.cloud); source != sources_.end()) {
        counters_.bytesWasted += source->second.bytes->progress(request.id).bytes;
        source->second.bytes->cancel(request.id);
    }
}

bool LoadQueue::isNearlyHere(const Request& request) const {
    auto source = sources_.find(request.cloud);
    if (source == sources_.end())
        return false;
    ByteSource::Progress progress = source->second.bytes->progress(request.id);
    bool isHalfHere = progress.bytes >= request.range.size - progress.bytes;
    bool isShort = progress.bytes + letFinishBytes_ >= request.range.size;
    bool isRegion = request.items.front().key.kind == LoadKind::region; // of a scan that was ended
    return (progress.hasBegun && (isHalfHere || isShort)) || (letsUnbegunFinish_ && isShort && !isRegion);
}

LoadQueue::Clock::time_point LoadQueue::notBefore(const LoadItem& item) const {
    Clock::time_point earliest = sources_.at(item.key.cloud).notBefore;
    if (auto failure = failures_.find(item.key); failure != failures_.end())
        earliest = std::max(earliest, failure->second.notBefore);
    return earliest;
}

// In a request that is on its way, as the gap between other things.
bool LoadQueue::isComing(std::uint32_t cloud, ByteRange range) const {
    return std::any_of(requests_.begin(), requests_.end(), [&](const auto& one) {
        const Request& request = one.second;
        return !request.cancelled && request.cloud == cloud && request.range.offset < range.end() &&
               range.offset < request.range.end();
    });
}

std::uint64_t LoadQueue::partBytes() const {
    std::uint64_t bytes = 0;
    for (const auto& [number, request] : requests_)
        if (!request.cancelled)
            bytes += sources_.at(request.cloud).bytes->progress(request.id).bytes;
    return bytes;
}

void LoadQueue::lookAtProgress(Clock::time_point now) {
    for (auto& [number, request] : requests_)
        if (!request.cancelled && !request.hasBegun) {
            ByteSource::Progress progress = sources_.at(request.cloud).bytes->progress(request.id);
            request.hasBegun = progress.hasBegun;
            if (progress.hasBegun)
                estimate_.begun(request.sent, progress.begunAt.value_or(now));
        }
}

void LoadQueue::start(const LoadLimits& limits, std::uint64_t bytesHeld, Clock::time_point now) {
    lookAtProgress(now);
    letFinishBytes_ = limits.letFinishBytes;
    letsUnbegunFinish_ = limits.letsUnbegunFinish;
    int mostRequests = std::max(1, limits.requests);
    if (waiting_.empty() || requestsInFlight_ >= mostRequests)
        return;
    LoadMerger merger(waiting_, limits, [&](std::uint32_t cloud, ByteRange gap) {
        return sources_.at(cloud).received.overlaps(gap) || isComing(cloud, gap);
    });
    for (std::size_t i = 0; i < waiting_.size(); ++i)
        if (notBefore(waiting_[i]) > now || isComing(waiting_[i].key.cloud, waiting_[i].range))
            merger.take(i);
    std::vector<bool> sent(waiting_.size());
    std::vector<std::vector<LoadItem>> sending;
    std::uint64_t bytes = bytesInFlight_ + bytesHeld;
    int requests = requestsInFlight_;
    for (std::size_t i = 0; i < waiting_.size() && requests < mostRequests; ++i) {
        if (merger.isTaken(i))
            continue;
        bool readsOver = sources_.at(waiting_[i].key.cloud).bytes->readsOverGaps();
        LoadMerger::Together together = merger.takeAround(i, readsOver ? limits.mergeGapBytes : 0);
        // One request is always allowed, however large its range.
        if (bytes > 0 && (bytes >= limits.bytes || together.range.size > limits.bytes - bytes))
            break;
        bytes += together.range.size;
        ++requests;
        auto& items = sending.emplace_back();
        for (std::size_t member : together.items) {
            sent[member] = true;
            items.push_back(std::move(waiting_[member]));
        }
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < waiting_.size(); ++i)
        if (!sent[i]) {
            if (kept != i)
                waiting_[kept] = std::move(waiting_[i]);
            ++kept;
        }
    waiting_.resize(kept);
    isPipeShort_ =
        requests >= mostRequests && bytes <= limits.pipeBytes + limits.pipeBytes / 4 && !waiting_.empty();
    for (auto& items : sending) // last: a source may answer at once
        send(std::move(items), now);
}

void LoadQueue::send(std::vector<LoadItem> items, Clock::time_point now) {
    std::uint64_t number = ++lastRequest_;
    Request& request = requests_[number];
    request.cloud = items.front().key.cloud;
    request.range = items.front().range;
    for (const LoadItem& item : items) {
        request.range = unionOf(request.range, item.range);
        travelling_[item.key] = number;
    }
    request.sent = estimate_.sent(now, partBytes());
    counters_.requestsRetried += std::any_of(
        items.begin(), items.end(), [&](const LoadItem& item) { return failures_.contains(item.key); });
    ++counters_.requests;
    counters_.requestsMerged += items.size() - 1;
    counters_.bytesRequested += request.range.size;
    ++requestsInFlight_;
    bytesInFlight_ += request.range.size;
    request.items = std::move(items);

    ByteRange range = request.range;
    reading_ = number;
    auto id = sources_.at(request.cloud).bytes->read(range, [self = self_, number](Result<Bytes> bytes) {
        if (*self)
            (*self)->arrivals_.push_back({number, std::move(bytes), (*self)->reading_ == number});
    });
    reading_ = 0;
    if (auto still = requests_.find(number); still != requests_.end())
        still->second.id = id;
}

std::vector<Loaded> LoadQueue::take(Clock::time_point now) {
    std::vector<Loaded> loaded;
    std::vector<Arrival> arrivals = std::move(arrivals_);
    arrivals_.clear();
    for (const Arrival& arrival : arrivals)
        if (arrival.bytes.ok() && !arrival.isImmediate)
            estimate_.delivered(arrival.bytes->size());
    for (Arrival& arrival : arrivals) {
        auto at = requests_.find(arrival.request);
        if (at == requests_.end())
            continue;
        Request request = std::move(at->second);
        requests_.erase(at);
        noteArrival(request, arrival, now);
        if (!request.cancelled)
            settle(request, std::move(arrival.bytes), now, loaded);
    }
    std::erase_if(waiting_, [&](const LoadItem& item) { return sources_.at(item.key.cloud).isStopped; });
    return loaded;
}

void LoadQueue::noteArrival(const Request& request, const Arrival& arrival, Clock::time_point now) {
    auto source = sources_.find(request.cloud);
    if (arrival.bytes.ok()) {
        std::uint64_t bytes = arrival.bytes->size();
        counters_.bytesReceived += bytes;
        if (!arrival.isImmediate)
            estimate_.arrived(request.sent, bytes, now, partBytes(), request.hasBegun);
        if (source != sources_.end()) {
            counters_.bytesFetchedTwice += source->second.received.add({request.range.offset, bytes});
            source->second.failures = 0;
        }
    } else if (!request.cancelled && source != sources_.end()) {
        noteFailure(source->second, arrival.bytes.error(), now);
    }
}

// Requests that fail together, before the pause that the first of them caused is over, are one failure.
void LoadQueue::noteFailure(Source& source, const Error& error, Clock::time_point now) {
    if (error.code != ErrorCode::networkFailed && !isRefusal(error.code))
        return;
    source.last = error;
    source.isStopped |= isRefusal(error.code);
    bool isPausing = source.failures > 0 && now < source.notBefore;
    if (!isPausing)
        ++source.failures;
    source.isStopped |= source.failures >= maxAttempts;
    Clock::duration pause = std::chrono::seconds(error.retryAfterSeconds);
    source.notBefore = std::max(source.notBefore, now + std::max(pause, pauseAfter(source.failures)));
}

void LoadQueue::settle(Request& request, Result<Bytes> bytes, Clock::time_point now,
                       std::vector<Loaded>& loaded) {
    --requestsInFlight_;
    bytesInFlight_ -= request.range.size;
    for (const LoadItem& item : request.items)
        travelling_.erase(item.key);
    if (!bytes.ok()) {
        ++counters_.requestsFailed;
        for (LoadItem& item : request.items)
            fail(std::move(item), bytes.error(), now, loaded);
        return;
    }
    keepGaps(request, *bytes);
    bool whole = bytes->size() == request.range.size;
    if (!whole && !request.items.front().mayEndEarly)
        ++counters_.requestsFailed;
    for (LoadItem& item : request.items) {
        std::uint64_t skip = std::min<std::uint64_t>(item.range.offset - request.range.offset, bytes->size());
        std::uint64_t size = std::min<std::uint64_t>(item.range.size, bytes->size() - skip);
        if (size < item.range.size && !item.mayEndEarly) {
            fail(std::move(item),
                 {ErrorCode::truncated,
                  say("the file ends inside bytes ", item.range.offset, " to ", item.range.end()), "",
                  say("fetch or convert it again")},
                 now, loaded);
            continue;
        }
        failures_.erase(item.key);
        Bytes part = std::move(item.head);
        auto from = bytes->begin() + static_cast<std::ptrdiff_t>(skip);
        part.insert(part.end(), from, from + static_cast<std::ptrdiff_t>(size));
        loaded.push_back({std::move(item), std::move(part)});
    }
}

void LoadQueue::keepGaps(const Request& request, const Bytes& bytes) {
    std::vector<ByteRange> ranges;
    for (const LoadItem& item : request.items)
        ranges.push_back(item.range);
    std::sort(ranges.begin(), ranges.end(),
              [](const ByteRange& a, const ByteRange& b) { return a.offset < b.offset; });
    std::uint64_t end = request.range.offset;
    for (const ByteRange& range : ranges) {
        if (range.offset > end && range.offset - request.range.offset <= bytes.size()) {
            auto from = bytes.begin() + static_cast<std::ptrdiff_t>(end - request.range.offset);
            auto to = bytes.begin() + static_cast<std::ptrdiff_t>(range.offset - request.range.offset);
            gaps_.push_back({request.cloud, end, Bytes(from, to)});
        }
        end = std::max(end, range.end());
    }
}

void LoadQueue::fail(LoadItem item, const Error& error, Clock::time_point now, std::vector<Loaded>& loaded) {
    Failure& failure = failures_[item.key];
    ++failure.attempts;
    failure.last = error;
    auto source = sources_.find(item.key.cloud);
    bool isOver = source == sources_.end() || source->second.isStopped;
    if (failure.attempts < mostAttempts(error.code) && !isOver) {
        failure.notBefore = now + pauseAfter(failure.attempts);
        waiting_.insert(waiting_.begin(), std::move(item));
        return;
    }
    failures_.erase(item.key);
    loaded.push_back({std::move(item), error});
}

bool LoadQueue::awaits(std::uint32_t cloud) const {
    return std::any_of(requests_.begin(), requests_.end(),
                       [&](const auto& request) { return request.second.cloud == cloud; });
}

std::optional<Error> LoadQueue::passingFailure(std::optional<std::uint32_t> cloud) const {
    auto failureOf = [&](const LoadKey& key) -> const Failure* {
        auto failure = failures_.find(key);
        bool isMeant = failure != failures_.end() && key.cloud == cloud.value_or(key.cloud);
        return isMeant ? &failure->second : nullptr;
    };
    for (const LoadItem& item : waiting_)
        if (const Failure* failure = failureOf(item.key))
            return failure->last;
    for (const auto& [key, request] : travelling_)
        if (const Failure* failure = failureOf(key))
            return failure->last;
    return std::nullopt;
}

LoadQueue::Clock::time_point LoadQueue::nextRetry(std::optional<std::uint32_t> cloud) const {
    auto earliest = Clock::time_point::max();
    for (const LoadItem& item : waiting_)
        if (item.key.cloud == cloud.value_or(item.key.cloud) &&
            (failures_.contains(item.key) || sources_.at(item.key.cloud).failures > 0))
            earliest = std::min(earliest, notBefore(item));
    return earliest;
}

std::optional<Error> LoadQueue::stopped(std::uint32_t cloud) const {
    auto source = sources_.find(cloud);
    if (source == sources_.end() || !source->second.isStopped)
        return std::nullopt;
    return source->second.last;
}

void LoadQueue::retry(std::uint32_t cloud) {
    std::erase_if(failures_, [&](const auto& failure) { return failure.first.cloud == cloud; });
    if (auto at = sources_.find(cloud); at != sources_.end()) {
        at->second.failures = 0;
        at->second.notBefore = {};
        at->second.isStopped = false;
    }
}

} // namespace stipple
