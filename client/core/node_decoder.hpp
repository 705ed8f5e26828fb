// Turning fetched bytes into a ResidentNode, possibly elsewhere: inline in tests, on threads natively, in
// Web Workers in the browser. decodeNode is the pure function that all of them run.
#pragma once

#include "client/core/resident_node.hpp"
#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/format/node_entry.hpp"

#include <chrono>
#include <functional>
#include <memory>

namespace stipple {

struct DecodeJob {
    std::uint32_t cloud = 0; // index of the cloud; a worker keeps its metadata
    std::shared_ptr<const CloudMetadata> metadata;
    NodeEntry entry;
    int strata = strataCount; // 1..4: `picture` holds this many
    Bytes picture;            // entry.strataRange(strata)
    bool wantsIntensity = false;
    Bytes intensity; // attribute block that holds Intensity; empty if it is the picture colour or unwanted
};

Result<ResidentNode> decodeNode(const DecodeJob& job);

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
