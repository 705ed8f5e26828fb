#include "client/core/cloud_loader.hpp"

#include "shared/base/text.hpp"
#include "shared/format/cloud_file.hpp"

#include <algorithm>
#include <utility>

namespace stipple {

void CloudLoader::advanceOpening() {
    Result<OpenStep> step = format->open(fetched);
    if (!step.ok())
        return fail(step.error());
    if (ByteRange* needed = std::get_if<ByteRange>(&*step)) {
        // Asked for again although it was fetched: the file is shorter than it says.
        if (openingNeeds == *needed)
            return fail({ErrorCode::truncated,
                         say("the file ends before byte ", needed->end(), ", which its header names"), "",
                         say("fetch or convert it again")});
        openingNeeds = *needed;
        return;
    }
    opened = std::move(std::get<OpenedCloud>(*step));
    if (source->sizeBytes() > 0 && source->sizeBytes() != opened.fileBytes)
        return fail({ErrorCode::truncated,
                     say("the file has ", source->sizeBytes(), " bytes instead of ", opened.fileBytes), "",
                     say("fetch or convert it again")});
    Result<Hierarchy> created = Hierarchy::create(opened.metadata, std::move(opened.rootNodes));
    if (!created.ok())
        return fail(created.error());
    hierarchy = std::move(*created);
    residency.resize(hierarchy.size());
    openingNeeds.reset();
    state.metadata = opened.metadata;
    state.stage = CloudStage::ready;
}

Bytes CloudLoader::metadataBlock() const {
    std::optional<ByteSpan> block = ready() ? fetched.find(opened.metadataBlock) : std::nullopt;
    return block ? Bytes(block->begin(), block->end()) : Bytes();
}

Error CloudLoader::placed(const Error& error) const {
    // Sources name themselves; the core's own errors name the node.
    return error.where.starts_with(source->name()) ? error : error.at(source->name());
}

void CloudLoader::fail(const Error& error) {
    state.stage = CloudStage::failed;
    state.error = placed(error);
    openingNeeds.reset();
    fetched = {};
    hierarchy = {};
    residency.clear();
    lostNodes.clear();
    lostChunks.clear();
    state.lastLoss.reset();
}

void CloudLoader::reset() {
    state.stage = CloudStage::opening;
    state.error = {};
    state.metadata = nullptr;
    state.interrupted.reset();
    state.lastLoss.reset();
    fetched = {};
    openingNeeds.reset();
    opened = {};
    hierarchy = {};
    residency.clear();
    decodeFailures.clear();
    damagedChunks.clear();
    lostNodes.clear();
    lostChunks.clear();
    needs = {};
}

void CloudLoader::loseNode(std::uint32_t node, const Error& why) {
    state.lastLoss = placed(why);
    if (!std::exchange(residency[node].failed, true))
        lostNodes.push_back(node);
}

void CloudLoader::loseChunk(std::uint32_t parent, const Error& why) {
    state.lastLoss = placed(why);
    hierarchy.markChildrenFailed(parent);
    lostChunks.push_back(parent);
}

void CloudLoader::takeUpLost() {
    state.lastLoss.reset();
    for (std::uint32_t node : std::exchange(lostNodes, {})) {
        residency[node].failed = false;
        if (auto failures = decodeFailures.find(node); failures != decodeFailures.end())
            failures->second = 1; // so that it is fetched anew
    }
    for (std::uint32_t parent : std::exchange(lostChunks, {}))
        hierarchy.markChildrenMissing(parent);
}

Status CloudLoader::addChunk(std::uint32_t parent, ByteSpan block) {
    Result<std::vector<NodeEntry>> nodes = format->parseChunk(opened, block);
    Status status = nodes.ok() ? hierarchy.add(parent, std::move(*nodes)) : Status(nodes.error());
    residency.resize(hierarchy.size());
    return status;
}

void CloudLoader::updateResidency(std::uint32_t node, const CachedNode* cached) {
    NodeResidency& here = residency[node];
    bool drawable = cached && cached->node &&
                    std::all_of(needs.blocks.begin(), needs.blocks.end(),
                                [&](int block) { return cached->hasBlock(block); });
    here.points = drawable ? cached->node->pointCount : 0;
}

LoadItem CloudLoader::itemFor(LoadKind kind, std::uint64_t id, ByteRange range) const {
    LoadItem item;
    item.key = {state.id, kind, id};
    std::uint64_t here = fetched.headBytes(range);
    if (here > 0) {
        ByteSpan head = *fetched.find({range.offset, here});
        item.head.assign(head.begin(), head.end());
    }
    ByteRange rest{range.offset + here, range.size - here};
    if (std::uint64_t more = kept ? kept->headBytes(state.id, rest) : 0; more > 0) {
        kept->append(state.id, {rest.offset, more}, item.head);
        here += more;
    }
    item.range = {range.offset + here, range.size - here};
    return item;
}

std::optional<LoadItem> CloudLoader::openingItem() const {
    if (!opening() || !openingNeeds)
        return std::nullopt;
    LoadItem item;
    item.key = {state.id, LoadKind::opening, openingNeeds->offset};
    item.range = *openingNeeds;
    item.mayEndEarly = true;
    return item;
}

LoadItem CloudLoader::chunkItem(std::uint32_t parent) const {
    ByteRange range = hierarchy.node(parent).entry.childChunk;
    if (!damagedChunks.contains(parent))
        return itemFor(LoadKind::chunk, parent, range);
    LoadItem item;
    item.key = {state.id, LoadKind::chunk, parent};
    item.range = range;
    return item;
}

std::optional<LoadItem> CloudLoader::pictureItem(std::uint32_t node, int strata,
                                                 const CachedNode* cached) const {
    int have = cached ? cached->strataFetched : 0;
    if (have >= strata)
        return std::nullopt;
    const NodeEntry& entry = hierarchy.node(node).entry;
    std::uint64_t from = entry.strataRange(have).end();
    ByteRange range{from, entry.strataRange(strata).end() - from};
    LoadItem item;
    if (decodeFailures.contains(node)) { // what is kept did not decode: fetch anew
        item.key = {state.id, LoadKind::picture, node};
        item.range = range;
    } else {
        item = itemFor(LoadKind::picture, node, range);
        // The strata that are wholly here come first, without waiting for the others.
        for (int s = strata; s > have && item.range.size > 0; --s) {
            std::uint64_t size = entry.strataRange(s).end() - from;
            if (size <= item.head.size()) {
                item.head.resize(static_cast<std::size_t>(size));
                item.range = {from + size, 0};
                strata = s;
            }
        }
    }
    item.fromStrata = have;
    item.strata = strata;
    return item;
}

LoadItem CloudLoader::pointsItem(std::uint32_t node) const {
    const NodeEntry& entry = hierarchy.node(node).entry;
    return itemFor(LoadKind::points, node, {entry.offsetBytes, entry.sizeBytes()});
}

LoadItem CloudLoader::regionItem(ByteRange range, const Bytes* head) const {
    if (!head)
        return itemFor(LoadKind::region, 0, range);
    std::uint64_t here = std::min<std::uint64_t>(head->size(), range.size);
    LoadItem rest = itemFor(LoadKind::region, 0, {range.offset + here, range.size - here});
    rest.head.insert(rest.head.begin(), head->begin(), head->begin() + static_cast<std::ptrdiff_t>(here));
    return rest;
}

void CloudLoader::addBlockItems(std::uint32_t node, const CachedNode* cached,
                                std::vector<LoadItem>& items) const {
    for (int block : needs.blocks)
        if (auto item = blockItem(node, block, cached))
            items.push_back(std::move(*item));
}

void CloudLoader::addWatchedItems(std::uint32_t node, const CachedNode* cached,
                                  std::vector<LoadItem>& items) const {
    if (residency[node].failed || !cached || !cached->node)
        return;
    for (int block : watched.blocks)
        if (auto item = blockItem(node, block, cached))
            items.push_back(std::move(*item));
    // Exact colours are coded against the whole node's picture.
    if (watched.exactBlock >= 0 && lacksExact(node, *cached) &&
        cached->node->pointCount == cached->node->totalPoints)
        if (auto item = blockItem(node, watched.exactBlock, cached))
            items.push_back(std::move(*item));
}

bool CloudLoader::lacksExact(std::uint32_t node, const CachedNode& cached) const {
    std::vector<AttributeBlock> blocks = attributeBlocks(*opened.metadata);
    for (std::size_t b = 0; b < blocks.size(); ++b)
        if (blocks[b].isExactColour && hierarchy.node(node).entry.attributeBytes[b] > 0)
            return !cached.hasBlock(static_cast<int>(b));
    return false;
}

bool CloudLoader::hasWatched(std::uint32_t node, const CachedNode& cached) const {
    bool mayBeExact = watched.exactBlock >= 0 && cached.node->pointCount == cached.node->totalPoints;
    return std::all_of(watched.blocks.begin(), watched.blocks.end(),
                       [&](int block) { return cached.hasBlock(block); }) &&
           !(mayBeExact && lacksExact(node, cached));
}

std::optional<LoadItem> CloudLoader::blockItem(std::uint32_t node, int block,
                                               const CachedNode* cached) const {
    if (cached && cached->block(block))
        return std::nullopt;
    const NodeEntry& entry = hierarchy.node(node).entry;
    LoadItem item =
        itemFor(LoadKind::attributes, node, entry.attributeRange(static_cast<std::size_t>(block)));
    item.key.block = block;
    return item;
}

} // namespace stipple
