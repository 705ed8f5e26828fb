#include "client/core/load_merging.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace stipple {

namespace {

// Larger gaps may take up half of a request.
constexpr std::uint64_t smallGapBytes = 4096;

ByteRange gapBetween(ByteRange a, ByteRange b) {
    if (b.offset > a.end())
        return {a.end(), b.offset - a.end()};
    return {b.end(), a.offset > b.end() ? a.offset - b.end() : 0};
}

bool isRegion(const LoadItem& item) {
    return item.key.kind == LoadKind::region;
}

} // namespace

ByteRange unionOf(ByteRange a, ByteRange b) {
    std::uint64_t offset = std::min(a.offset, b.offset);
    return {offset, std::max(a.end(), b.end()) - offset};
}

LoadMerger::LoadMerger(const std::vector<LoadItem>& items, const LoadLimits& limits, IsHere isHere)
    : items_(items), limits_(limits), isHere_(std::move(isHere)), order_(items.size()), place_(items.size()),
      taken_(items.size()) {
    for (std::size_t i = 0; i < order_.size(); ++i)
        order_[i] = i;
    std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
        const LoadItem &x = items_[a], &y = items_[b];
        return std::tie(x.key.cloud, x.range.offset, x.key) < std::tie(y.key.cloud, y.range.offset, y.key);
    });
    for (std::size_t i = 0; i < order_.size(); ++i)
        place_[order_[i]] = i;
}

LoadMerger::Together LoadMerger::takeAround(std::size_t first, std::uint64_t mostGapBytes) {
    Together together{{first}, items_[first].range};
    taken_[first] = true;
    usefulBytes_ = together.range.size;
    if (items_[first].mayEndEarly)
        return together;
    std::size_t after = place_[first] + 1, before = place_[first];
    for (bool more = true; more;) {
        more = false;
        if (after < order_.size() && tryAdd(together, order_[after], mostGapBytes))
            more = true, ++after;
        if (before > 0 && tryAdd(together, order_[before - 1], mostGapBytes))
            more = true, --before;
    }
    return together;
}

bool LoadMerger::tryAdd(Together& together, std::size_t item, std::uint64_t mostGapBytes) {
    const LoadItem &first = items_[together.items.front()], &more = items_[item];
    if (taken_[item] || more.key.cloud != first.key.cloud || more.mayEndEarly)
        return false;
    // What the picture waits for travels without what it doesn't.
    if (isRegion(more) != isRegion(first))
        return false;
    if (!limits_.mergesNodes && more.key.id != first.key.id)
        return false;
    ByteRange gap = gapBetween(together.range, more.range), merged = unionOf(together.range, more.range);
    if (gap.size > mostGapBytes || merged.size > limits_.mergedRequestBytes)
        return false;
    if (gap.size > smallGapBytes && merged.size > 2 * (usefulBytes_ + more.range.size))
        return false;
    if (gap.size > 0 && isHere_(more.key.cloud, gap))
        return false;
    usefulBytes_ += more.range.size;
    taken_[item] = true;
    together.items.push_back(item);
    together.range = merged;
    return true;
}

} // namespace stipple
