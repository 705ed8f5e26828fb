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
    int strata = strataCount; // 0..4: `picture` holds this many; 0: only the intensity is wanted
    Bytes picture;            // entry.strataRange(strata)
    bool wantsIntensity = false;
    Bytes intensity; // the block that holds Intensity (intensityBlock); empty if it is not wanted
};

// Decodes and packs. With strata 0 the node has no positions, and pointCount is that of `intensity`, all
// the node's points in progressive order. Otherwise intensities are those of the prefix.
// Errors: corrupt or truncated, placed at the node's key; cancelled once the gate is closed. Pure; safe on
// untrusted bytes.
Result<ResidentNode> decodeNode(const DecodeJob& job, const WorkGate* gate = nullptr);

// Index of the block with the attribute Intensity for NodeEntry::attributeRange; -1 if there is none
// because the cloud has no such attribute, or because it is the picture's colour.
int intensityBlock(const CloudMetadata& metadata);

// `node` with the intensities of its prefix out of those of all its points, and a new id.
ResidentNode withIntensity(const ResidentNode& node, const std::vector<float>& intensities);

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
