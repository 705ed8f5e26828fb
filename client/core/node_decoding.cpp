#include "client/core/node_decoding.hpp"

#include <utility>

namespace stipple {

namespace {

constexpr int maxDecodeAttempts = 2;

} // namespace

NodeDecoding::NodeDecoding(NodeDecoder& decoder, NodeCache& cache, SessionCounters& counters)
    : decoder_(decoder), cache_(cache), counters_(counters) {}

NodeDecoding::~NodeDecoding() {
    *alive_ = false;
}

void NodeDecoding::takePicture(CloudLoader& cloud, std::uint32_t node, Loaded& loaded) {
    CacheKey key{cloud.state.id, node};
    const NodeEntry& entry = cloud.hierarchy.node(node).entry;
    CachedNode& cached = cache_.obtain(key, entry.key.level);
    if (cached.strataFetched != loaded.item.fromStrata) {
        // What these bytes continue was dropped in between.
        cloud.kept->add(cloud.state.id, entry.strataRange(loaded.item.fromStrata).end(),
                        std::move(*loaded.bytes));
        return;
    }
    if (cached.compressed.empty())
        cached.compressed = std::move(*loaded.bytes);
    else
        cached.compressed.insert(cached.compressed.end(), loaded.bytes->begin(), loaded.bytes->end());
    if (cached.strataFetched == 0 && !cached.node)
        for (std::uint32_t bytes : entry.attributeBytes)
            counters_.attributeBytesOffered += bytes;
    cached.strataFetched = loaded.item.strata;
    cache_.recount(key);
    if (!cached.decodingPicture)
        decodePicture(cloud, node, cached);
}

void NodeDecoding::takeBlock(CloudLoader& cloud, std::uint32_t node, int block, Bytes bytes) {
    const NodeEntry& entry = cloud.hierarchy.node(node).entry;
    CachedNode& cached = cache_.obtain({cloud.state.id, node}, entry.key.level);
    counters_.attributeBytesFetched += bytes.size();
    if (cached.block(block))
        return; // here, or on its way
    cloud.kept->add(cloud.state.id, entry.attributeRange(static_cast<std::size_t>(block)).offset, bytes);
    DecodeJob job;
    job.entry = entry;
    job.strata = 0;
    job.block = block;
    job.attributes = std::move(bytes);
    if (block == cloud.needs.exactBlock || block == cloud.watched.exactBlock) {
        if (!cached.node || cached.node->pointCount < cached.node->totalPoints)
            return; // what they are coded against was dropped in between
        job.shown = shownColours(*cached.node);
    }
    cached.blocks.push_back({block, true, nullptr});
    decode(cloud, node, std::move(job));
}

NodeDecoding::Taken NodeDecoding::takeAnswers(CloudMap& clouds) {
    Taken taken;
    std::deque<Answer> answers = std::move(answers_);
    answers_.clear();
    for (Answer& answer : answers) {
        --pending_;
        bytesPending_ -= answer.bytes;
        taken.changed = true; // also where only something else can begin now
        auto at = clouds.find(answer.key.cloud);
        CachedNode* cached = cache_.find(answer.key);
        if (at == clouds.end() || !at->second.ready() || !cached)
            continue; // removed, failed or evicted meanwhile
        CloudLoader& cloud = at->second;
        if (answer.strata > 0)
            cached->decodingPicture = false;
        if (!answer.node.ok()) {
            if (takeFailure(cloud, answer, *cached))
                taken.errors.push_back(cloud.placed(answer.node.error()));
        } else if (answer.strata > 0) {
            takeDecodedPicture(cloud, answer, *cached);
        } else {
            takeDecodedBlock(answer, *cached);
        }
        cache_.recount(answer.key);
        cloud.updateResidency(answer.key.node, cached);
    }
    return taken;
}

void NodeDecoding::decodePicture(CloudLoader& cloud, std::uint32_t node, CachedNode& cached) {
    DecodeJob job;
    job.entry = cloud.hierarchy.node(node).entry;
    job.strata = cached.strataFetched;
    job.picture = cached.compressed;
    cached.decodingPicture = true;
    cached.strataDecoding = job.strata;
    decode(cloud, node, std::move(job));
}

void NodeDecoding::decode(CloudLoader& cloud, std::uint32_t node, DecodeJob job) {
    job.cloud = cloud.state.id;
    job.metadata = cloud.opened.metadata;
    CacheKey key{cloud.state.id, node};
    int strata = job.strata, block = job.block;
    std::uint64_t bytes = job.picture.size() + job.attributes.size();
    bytesPending_ += bytes;
    ++pending_;
    decoder_.decode(std::move(job),
                    [this, alive = alive_, key, strata, block, bytes](Result<ResidentNode> decoded) {
                        if (*alive)
                            answers_.push_back({key, strata, block, bytes, std::move(decoded)});
                    });
}

bool NodeDecoding::takeFailure(CloudLoader& cloud, const Answer& answer, CachedNode& cached) {
    // The bytes may have been damaged on their way: once more from the start.
    const NodeEntry& entry = cloud.hierarchy.node(answer.key.node).entry;
    cloud.kept->erase(cloud.state.id, {entry.offsetBytes, entry.sizeBytes()});
    if (answer.strata > 0) {
        cached.compressed = {};
        cached.strataFetched = 0;
    } else {
        std::erase_if(cached.blocks, [&](const CachedBlock& one) { return one.block == answer.block; });
    }
    int failures = ++cloud.decodeFailures[answer.key.node];
    if (failures < maxDecodeAttempts)
        return false;
    cloud.loseNode(answer.key.node, answer.node.error());
    return true;
}

void NodeDecoding::takeDecodedPicture(CloudLoader& cloud, Answer& answer, CachedNode& cached) {
    ++counters_.nodesDecoded;
    counters_.pointsDecoded += answer.node->pointCount;
    ResidentNode node = std::move(*answer.node);
    bool complete = node.pointCount == node.totalPoints;
    cached.node = std::make_shared<const ResidentNode>(std::move(node));
    if (complete && !cached.compressed.empty()) {
        cached.strataFetched = strataCount; // strata may be empty
        cloud.kept->add(cloud.state.id, cloud.hierarchy.node(answer.key.node).entry.offsetBytes,
                        std::exchange(cached.compressed, {}));
    } else if (complete) {
        cached.strataFetched = strataCount;
    } else if (cached.strataFetched > answer.strata) {
        decodePicture(cloud, answer.key.node, cached);
    }
}

void NodeDecoding::takeDecodedBlock(Answer& answer, CachedNode& cached) {
    for (CachedBlock& one : cached.blocks)
        if (one.block == answer.block) {
            one.decoding = false;
            one.columns = std::make_shared<const NodeColumns>(std::move(answer.node->columns));
        }
}

} // namespace stipple
