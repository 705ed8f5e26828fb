// Turning fetched bytes into a ResidentNode, possibly elsewhere: inline in tests, on threads natively, in
// Web Workers in the browser. decodeNode is the pure function that all of them run.
#pragma once

#include "client/core/resident_node.hpp"
#include "shared/base/result.hpp"
#include "shared/base/work_gate.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/format/node_entry.hpp"

#include <chrono>
#include <functional>
#include <memory>

namespace stipple {

struct DecodeJob {
    std::uint32_t cloud = 0; // id of the cloud; a worker keeps its metadata
    std::shared_ptr<const CloudMetadata> metadata;
    NodeEntry entry;
    int strata = strataCount; // 1..4: `picture` holds this many; 0: a block of attributes is wanted instead
    Bytes picture;            // entry.strataRange(strata)
    std::int32_t block = 0;   // strata 0: which of attributeBlocks()
    Bytes attributes;         // strata 0: entry.attributeRange(block)
    // strata 0, a block of exact colours: what all the node's points show, which they are coded against
    // (shownColours()).
    Bytes shown;
    // Some points alone are wanted, all that the file says of each (their indices in progressive order, maybe
    // one twice): `picture` holds all bytes of the node, strata is strataCount.
    std::vector<std::uint32_t> points;
};

// Decodes and packs. With strata 0 the node has no positions but columns, of all its points in progressive
// order: those of the block, or exactColourWords or exactIntensity. With `points` it has exactPosition and
// every attribute's column, of those points in their order. Errors: corrupt or truncated, placed at the
// node's key; cancelled once the gate is closed. Pure; safe on untrusted bytes.
Result<ResidentNode> decodeNode(const DecodeJob& job, const WorkGate* gate = nullptr);

class NodeDecoder {
  public:
    using Completion = std::function<void(Result<ResidentNode>)>;
    virtual ~NodeDecoder() = default;

    // Answers exactly once, inside decode() or inside pump(), on the caller's thread.
    virtual void decode(DecodeJob job, Completion done) = 0;
    // Delivers what is ready, waiting up to `wait` for the first; returns the number delivered.
    virtual int pump(std::chrono::milliseconds wait) = 0;
    virtual std::size_t pending() const = 0;
};

std::unique_ptr<NodeDecoder> makeInlineDecoder();

} // namespace stipple
