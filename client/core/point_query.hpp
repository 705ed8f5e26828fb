// All that a file says of one point: its exact integers, its world coordinates, every attribute as stored. A
// session answers it by reading the point's node (ViewSession::askPoint).
//
// Thread: the session's.
#pragma once

#include "client/core/cloud_loader.hpp"
#include "client/core/node_decoder.hpp"
#include "client/core/point_record.hpp"

#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace stipple {

// The questions of a session that are on their way, and their answers. Several about one node read it once.
class PointQueries {
  public:
    // The decoder outlives this; it may answer even later.
    explicit PointQueries(NodeDecoder& decoder) : decoder_(decoder) {}
    ~PointQueries() { *alive_ = false; }

    // Errors: invalidArgument for a node or index that the cloud does not have, as far as its hierarchy is
    // known.
    Status ask(const CloudLoader& cloud, const PointIdentity& point);
    // What has to be read of that cloud.
    std::vector<LoadItem> items(const CloudLoader& cloud) const;
    // The bytes of a node, or why there are none. The decoder answers whatever was asked about it.
    void takeLoaded(const CloudLoader& cloud, std::uint32_t node, Result<Bytes> bytes);
    // Answers what is asked of a cloud that is gone.
    void cancel(CloudId cloud);

    bool pending() const { return !asked_.empty(); }
    bool decoding() const { return decoding_ > 0; }
    // The answers since the last call, each exactly once.
    std::vector<PointAnswer> take() { return std::exchange(answers_, {}); }

  private:
    struct Question {
        PointIdentity point;
        std::uint32_t node;      // index in the hierarchy
        std::uint32_t batch = 0; // in which it is decoded; 0: its node is still to come
    };
    // Answers the questions of a batch, the n-th of them by record(n).
    void answer(std::uint32_t batch, const std::function<Result<PointRecord>(std::size_t)>& record);

    NodeDecoder& decoder_;
    std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
    std::uint32_t lastBatch_ = 0;
    std::size_t decoding_ = 0; // jobs at the decoder
    std::vector<Question> asked_;
    std::vector<PointAnswer> answers_;
};

// The point's integers and world coordinates, without reading anything. `node` holds it.
PointRecord positionRecord(const CloudMetadata& metadata, const ResidentNode& node, std::uint32_t index);

} // namespace stipple
