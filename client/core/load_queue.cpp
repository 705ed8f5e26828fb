#include "client/core/load_queue.hpp"

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
};

namespace {

// A disk or network may recover; a file that ends early, contradicts itself or changed will not.
bool mayPass(ErrorCode code) {
    return code == ErrorCode::ioFailed || code == ErrorCode::networkFailed || code == ErrorCode::cancelled;
}

ByteRange unionOf(ByteRange a, ByteRange b) {
    std::uint64_t offset = std::min(a.offset, b.offset);
    return {offset, std::max(a.end(), b.end()) - offset};
}

// Takes `first` and then its neighbours in the file, alternately after and before, as far as limits allow.
// `order`: indices of items by cloud and offset; `place`: where an item is in it. Marks what it takes.
std::vector<std::size_t> mergeAround(std::size_t first, const std::vector<LoadItem>& items,
                                     const std::vector<std::size_t>& order,
                                     const std::vector<std::size_t>& place, std::vector<bool>& taken,
                                     const LoadLimits& limits, ByteRange& range) {
    std::vector<std::size_t> members{first};
    taken[first] = true;
    range = items[first].range;
    auto tryMember = [&](std::size_t at) {
        std::size_t index = order[at];
        const LoadItem& item = items[index];
        if (taken[index] || item.key.cloud != items[first].key.cloud || item.mayEndEarly)
            return false;
        if (!limits.mergesNodes && item.key.id != items[first].key.id)
            return false;
        std::uint64_t gap = item.range.offset > range.end()   ? item.range.offset - range.end()
                            : range.offset > item.range.end() ? range.offset - item.range.end()
                                                              : 0;
        ByteRange merged = unionOf(range, item.range);
        if (gap > limits.mergeGapBytes || merged.size > limits.mergedRequestBytes)
            return false;
        taken[index] = true;
        members.push_back(index);
        range = merged;
        return true;
    };
    if (items[first].mayEndEarly)
        return members;
    std::size_t after = place[first] + 1, before = place[first];
    for (bool more = true; more;) {
        more = false;
        if (after < order.size() && tryMember(after))
            more = true, ++after;
        if (before > 0 && tryMember(before - 1))
            more = true, --before;
    }
    return members;
}

} // namespace

LoadQueue::Clock::duration LoadQueue::pauseAfter(int attempts) {
    return std::chrono::milliseconds(250 << (2 * std::clamp(attempts - 1, 0, 4)));
}

LoadQueue::LoadQueue(SessionCounters& counters)
    : counters_(counters), self_(std::make_shared<LoadQueue*>(this)) {}

LoadQueue::~LoadQueue() {
    *self_ = nullptr; // completions that come later find nobody
}

void LoadQueue::addSource(std::uint32_t cloud, ByteSource& source) {
    sources_[cloud] = &source;
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
        if (!needed && !request.cancelled)
            cancel(request);
    }
    std::erase_if(items, [&](const LoadItem& item) {
        return travelling_.contains(item.key) || !sources_.contains(item.key.cloud);
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
    if (auto source = sources_.find(request.cloud); source != sources_.end())
        source->second->cancel(request.id);
}

bool LoadQueue::mayStart(const LoadItem& item, Clock::time_point now) const {
    auto failure = failures_.find(item.key);
    return failure == failures_.end() || failure->second.notBefore <= now;
}

void LoadQueue::start(const LoadLimits& limits, std::uint64_t bytesHeld, Clock::time_point now) {
    int mostRequests = std::max(1, limits.requests);
    if (waiting_.empty() || requestsInFlight_ >= mostRequests)
        return;
    std::vector<std::size_t> order(waiting_.size()), place(waiting_.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const LoadItem &x = waiting_[a], &y = waiting_[b];
        return std::tie(x.key.cloud, x.range.offset, x.key) < std::tie(y.key.cloud, y.range.offset, y.key);
    });
    for (std::size_t i = 0; i < order.size(); ++i)
        place[order[i]] = i;

    std::vector<bool> taken(waiting_.size()), sent(waiting_.size());
    for (std::size_t i = 0; i < taken.size(); ++i)
        taken[i] = !mayStart(waiting_[i], now);
    std::vector<std::vector<LoadItem>> sending;
    std::uint64_t bytes = bytesInFlight_ + bytesHeld;
    int requests = requestsInFlight_;
    for (std::size_t i = 0; i < waiting_.size() && requests < mostRequests; ++i) {
        if (taken[i])
            continue;
        ByteRange range;
        std::vector<std::size_t> members = mergeAround(i, waiting_, order, place, taken, limits, range);
        // One request is always allowed, however large its range.
        if (bytes > 0 && (bytes >= limits.bytes || range.size > limits.bytes - bytes))
            break;
        bytes += range.size;
        ++requests;
        for (std::size_t member : members)
            sent[member] = true;
        auto& items = sending.emplace_back();
        for (std::size_t member : members)
            items.push_back(std::move(waiting_[member]));
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < waiting_.size(); ++i)
        if (!sent[i]) {
            if (kept != i)
                waiting_[kept] = std::move(waiting_[i]);
            ++kept;
        }
    waiting_.resize(kept);
    for (auto& items : sending) // last: a source may answer at once
        send(std::move(items));
}

void LoadQueue::send(std::vector<LoadItem> items) {
    std::uint64_t number = ++lastRequest_;
    Request& request = requests_[number];
    request.cloud = items.front().key.cloud;
    request.range = items.front().range;
    for (const LoadItem& item : items) {
        request.range = unionOf(request.range, item.range);
        travelling_[item.key] = number;
    }
    ++counters_.requests;
    counters_.requestsMerged += items.size() - 1;
    counters_.bytesRequested += request.range.size;
    ++requestsInFlight_;
    bytesInFlight_ += request.range.size;
    request.items = std::move(items);

    ByteRange range = request.range;
    auto id = sources_.at(request.cloud)->read(range, [self = self_, number](Result<Bytes> bytes) {
        if (*self)
            (*self)->arrivals_.push_back({number, std::move(bytes)});
    });
    if (auto still = requests_.find(number); still != requests_.end())
        still->second.id = id;
}

std::vector<Loaded> LoadQueue::take(Clock::time_point now) {
    std::vector<Loaded> loaded;
    std::vector<Arrival> arrivals = std::move(arrivals_);
    arrivals_.clear();
    for (Arrival& arrival : arrivals) {
        auto at = requests_.find(arrival.request);
        if (at == requests_.end())
            continue;
        Request request = std::move(at->second);
        requests_.erase(at);
        if (arrival.bytes.ok())
            counters_.bytesReceived += arrival.bytes->size();
        if (!request.cancelled)
            settle(request, std::move(arrival.bytes), now, loaded);
    }
    return loaded;
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
    bool whole = bytes->size() == request.range.size;
    if (!whole && !request.items.front().mayEndEarly)
        ++counters_.requestsFailed;
    for (LoadItem& item : request.items) {
        std::uint64_t skip = std::min<std::uint64_t>(item.range.offset - request.range.offset, bytes->size());
        std::uint64_t size = std::min<std::uint64_t>(item.range.size, bytes->size() - skip);
        if (size < item.range.size && !item.mayEndEarly) {
            fail(std::move(item),
                 {ErrorCode::truncated,
                  cat("the file ends inside bytes ", item.range.offset, " to ", item.range.end()), "",
                  "fetch or convert it again"},
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

void LoadQueue::fail(LoadItem item, const Error& error, Clock::time_point now, std::vector<Loaded>& loaded) {
    Failure& failure = failures_[item.key];
    ++failure.attempts;
    failure.last = error;
    if (mayPass(error.code) && failure.attempts < maxAttempts) {
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

std::optional<Error> LoadQueue::passingFailure() const {
    for (const LoadItem& item : waiting_)
        if (auto failure = failures_.find(item.key); failure != failures_.end())
            return failure->second.last;
    for (const auto& [key, request] : travelling_)
        if (auto failure = failures_.find(key); failure != failures_.end())
            return failure->second.last;
    return std::nullopt;
}

LoadQueue::Clock::time_point LoadQueue::nextRetry() const {
    auto earliest = Clock::time_point::max();
    for (const LoadItem& item : waiting_)
        if (auto failure = failures_.find(item.key); failure != failures_.end())
            earliest = std::min(earliest, failure->second.notBefore);
    return earliest;
}

} // namespace stipple
