#include "client/core/region_scan.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <utility>

namespace stipple {

Result<std::unique_ptr<RegionScan>> RegionScan::make(RegionScanId id, const CloudLoader& cloud,
                                                     const RegionRequest& request) {
    if (!cloud.ready())
        return Error{ErrorCode::invalidArgument, say("the cloud is not open"), cloud.state.name, ""};
    std::unique_ptr<RegionScan> scan(new RegionScan(id, request, cloud.opened.metadata));
    STIPPLE_TRY(filter, CloudFilter::make(*scan->metadata_, request.filter));
    scan->filter_ = std::make_unique<CloudFilter>(std::move(filter));
    STIPPLE_TRY(chooser, PointChooser::make(*scan->metadata_, *scan->filter_, request.attributes));
    scan->chooser_ = std::make_unique<PointChooser>(std::move(chooser));
    scan->toVisit_.push_back(0);
    return scan;
}

bool RegionScan::advance(const CloudLoader& cloud) {
    if (progress_.error || progress_.complete)
        return false;
    if (cloud.state.interrupted) {
        fail(*cloud.state.interrupted);
        return true;
    }
    bool asksMore = visitChunks(cloud);
    for (std::size_t visits = 0; visits < visitsPerStep && !toVisit_.empty(); ++visits) {
        std::uint32_t node = toVisit_.front();
        toVisit_.pop_front();
        visit(cloud, node);
        asksMore = true;
    }
    asksMore |= ask(cloud);
    updateComplete();
    return asksMore;
}

void RegionScan::visit(const CloudLoader& cloud, std::uint32_t index) {
    const HierarchyNode& node = cloud.hierarchy.node(index);
    using Verdict = CloudFilter::Verdict;
    Verdict verdict = filter_->verdictOn(node.entry);
    bool isRead = verdict == Verdict::whole || verdict == Verdict::tested;
    progress_.nodesOutside += verdict == Verdict::outside;
    progress_.nodesNotWanted += verdict == Verdict::finer || verdict == Verdict::absent;
    if (isRead && node.entry.pointCount > 0) {
        wanted_.emplace(Order{node.entry.key.level, node.entry.offsetBytes, index},
                        verdict == Verdict::tested);
        progress_.nodesWhole += verdict == Verdict::whole;
        ++progress_.nodesToDo;
        progress_.pointsToDo += node.entry.pointCount;
    }
    if (!filter_->wantsBelow(node.entry) || node.entry.childMask == 0)
        return;
    if (node.childrenState != ChildrenState::known) {
        chunks_.push_back(index);
        return;
    }
    for (std::int32_t child : node.children)
        if (child >= 0)
            toVisit_.push_back(static_cast<std::uint32_t>(child));
}

// Chunks that have come since.
bool RegionScan::visitChunks(const CloudLoader& cloud) {
    auto before = chunks_.size();
    std::erase_if(chunks_, [&](std::uint32_t index) {
        const HierarchyNode& node = cloud.hierarchy.node(index);
        if (node.childrenState == ChildrenState::failed)
            fail({ErrorCode::corrupt, say("what lies below node ", node.entry.key.text(), " can't be had"),
                  cloud.state.name, say("see the messages before this one")});
        if (node.childrenState != ChildrenState::known)
            return false;
        for (std::int32_t child : node.children)
            if (child >= 0)
                toVisit_.push_back(static_cast<std::uint32_t>(child));
        return true;
    });
    progress_.chunksToDo = chunks_.size();
    return chunks_.size() != before;
}

// The strata, and the blocks of the attributes: neighbours are one run.
std::vector<ByteRange> RegionScan::runsOf(const NodeEntry& entry, std::span<const std::size_t> blocks) {
    std::vector<ByteRange> runs{entry.strataRange(strataCount)};
    for (std::size_t block : blocks) {
        ByteRange range = entry.attributeRange(block);
        if (range.offset == runs.back().end())
            runs.back().size += range.size;
        else if (range.size > 0)
            runs.push_back(range);
    }
    return runs;
}

// Nodes are asked for in their order, as long as what is ahead allows.
bool RegionScan::ask(const CloudLoader& cloud) {
    bool any = false;
    while (!wanted_.empty() && !progress_.error && bytesAhead_ < request_.bytesAhead) {
        auto [order, tested] = *wanted_.begin();
        const std::uint32_t index = std::get<2>(order);
        const NodeEntry& entry = cloud.hierarchy.node(index).entry;
        std::vector<std::size_t> blocks = blocksHolding(*metadata_, chooser_->attributesToRead(tested));
        if (!blocks.empty() && blocks.back() >= entry.attributeBytes.size()) {
            fail({ErrorCode::corrupt, say("node ", entry.key.text(), " has no such blocks"), cloud.state.name,
                  ""});
            return true;
        }
        Asked asked{order, entry, tested, 0, runsOf(entry, blocks), {}};
        asked.come.resize(asked.runs.size());
        for (const ByteRange& run : asked.runs)
            asked.bytes += run.size;
        if (bytesAhead_ > 0 && bytesAhead_ + asked.bytes > request_.bytesAhead)
            break;
        bytesAhead_ += asked.bytes;
        asked_.emplace(index, std::move(asked));
        wanted_.erase(wanted_.begin());
        any = true;
    }
    return any;
}

std::vector<LoadItem> RegionScan::items(const CloudLoader& cloud, NodeCache& cache) const {
    std::vector<LoadItem> items;
    if (progress_.error)
        return items;
    for (std::uint32_t index : chunks_)
        if (cloud.hierarchy.node(index).childrenState == ChildrenState::missing)
            items.push_back(cloud.chunkItem(index));
    for (const auto& [index, asked] : asked_) {
        const CachedNode* cached = cache.find({request_.cloud, index});
        bool hasHead = cached && !cached->compressed.empty();
        for (std::size_t run = 0; run < asked.runs.size(); ++run) {
            if (asked.come[run])
                continue;
            LoadItem item =
                cloud.regionItem(asked.runs[run], run == 0 && hasHead ? &cached->compressed : nullptr);
            item.key.id = keyId(index, run);
            item.key.block = id_;
            items.push_back(std::move(item));
        }
    }
    return items;
}

void RegionScan::takeLoaded(const LoadItem& item, Result<Bytes> bytes) {
    auto at = asked_.find(static_cast<std::uint32_t>(item.key.id));
    auto run = static_cast<std::size_t>(item.key.id >> 32);
    if (at == asked_.end() || run >= at->second.runs.size() || at->second.come[run])
        return;
    Asked& asked = at->second;
    if (!bytes.ok())
        return fail(bytes.error().at("node " + asked.entry.key.text()));
    progress_.bytesRead += bytes->size();
    asked.come[run] = std::move(*bytes);
    if (!std::all_of(asked.come.begin(), asked.come.end(), [](const auto& part) { return part.has_value(); }))
        return;
    RegionNode ready;
    ready.tested = asked.tested;
    ready.node.attributes = chooser_->attributesToRead(asked.tested);
    ready.node.bytes = std::move(*asked.come[0]);
    for (std::size_t i = 1; i < asked.come.size(); ++i)
        ready.node.bytes.insert(ready.node.bytes.end(), asked.come[i]->begin(), asked.come[i]->end());
    ready.node.entry = std::move(asked.entry);
    ready_.emplace(asked.order, std::move(ready));
    asked_.erase(at);
}

void RegionScan::fail(const Error& error) {
    if (progress_.error || progress_.complete)
        return;
    progress_.error = error;
    toVisit_.clear();
    wanted_.clear();
    asked_.clear();
    ready_.clear();
    bytesAhead_ = 0;
}

std::vector<RegionNode> RegionScan::take(std::size_t most) {
    std::vector<RegionNode> nodes;
    while (!ready_.empty() && nodes.size() < most) {
        RegionNode& next = nodes.emplace_back(std::move(ready_.begin()->second));
        ready_.erase(ready_.begin());
        bytesAhead_ -= next.node.bytes.size();
        ++progress_.nodesDone;
        --progress_.nodesToDo;
        progress_.pointsDone += next.node.entry.pointCount;
        progress_.pointsToDo -= next.node.entry.pointCount;
    }
    updateComplete();
    return nodes;
}

void RegionScan::updateComplete() {
    progress_.chunksToDo = chunks_.size();
    progress_.hierarchyKnown = toVisit_.empty() && chunks_.empty();
    progress_.complete = !progress_.error && progress_.hierarchyKnown && progress_.nodesToDo == 0;
}

} // namespace stipple
