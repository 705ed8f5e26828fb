// The decoding of a session: what was loaded of a node becomes a node to draw, stratum by stratum.
//
//   loaded bytes → CachedNode::compressed → decoder → CachedNode::node
//
// Thread: the session's.
#pragma once

#include "client/core/cloud_loader.hpp"
#include "client/core/counters.hpp"
#include "client/core/load_queue.hpp"
#include "client/core/node_cache.hpp"
#include "client/core/node_decoder.hpp"

#include <deque>
#include <memory>

namespace stipple {

class NodeDecoding {
  public:
    // All three outlive this; the decoder may answer even later.
    NodeDecoding(NodeDecoder& decoder, NodeCache& cache, SessionCounters& counters);
    ~NodeDecoding();

    // The next strata of a node, or one of its further blocks.
    void takePicture(CloudLoader& cloud, std::uint32_t node, Loaded& loaded);
    void takeBlock(CloudLoader& cloud, std::uint32_t node, int block, Bytes bytes);

    bool pending() const { return pending_ > 0; }
    std::uint64_t bytesPending() const { return bytesPending_; }
    bool hasAnswers() const { return !answers_.empty(); }

    struct Taken {
        bool changed = false;      // what can be drawn, or should be asked for
        std::vector<Error> errors; // of nodes that are given up
    };
    // Puts what the decoder has answered into the cache. A block that does not decode is to be fetched once
    // more.
    Taken takeAnswers(CloudMap& clouds);

  private:
    struct Answer {
        CacheKey key;
        int strata; // 0: a further block
        int block;
        std::uint64_t bytes;
        Result<ResidentNode> node;
    };

    void decodePicture(CloudLoader& cloud, std::uint32_t node, CachedNode& cached);
    void decode(CloudLoader& cloud, std::uint32_t node, DecodeJob job);
    // True if the node is given up.
    static bool takeFailure(CloudLoader& cloud, const Answer& answer, CachedNode& cached);
    void takeDecodedPicture(CloudLoader& cloud, Answer& answer, CachedNode& cached);
    static void takeDecodedBlock(Answer& answer, CachedNode& cached);

    NodeDecoder& decoder_;
    NodeCache& cache_;
    SessionCounters& counters_;
    std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
    std::deque<Answer> answers_; // of the decoder, not taken in yet
    std::size_t pending_ = 0;
    std::uint64_t bytesPending_ = 0;
};

} // namespace stipple
