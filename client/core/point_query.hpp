// All that a file says of one point: its exact integers, its world coordinates, every attribute as stored. A
// session answers it by reading the point's node (ViewSession::askPoint).
//
// Thread: the session's.
#pragma once

#include "client/core/cloud_loader.hpp"
#include "client/core/point_record.hpp"

#include <utility>
#include <vector>

namespace stipple {

// The questions of a session that are on their way, and their answers. Several about one node read it once.
class PointQueries {
  public:
    // Errors: invalidArgument for a node or index that the cloud does not have, as far as its hierarchy is
    // known.
    Status ask(const CloudLoader& cloud, const PointIdentity& point);
    // What has to be read of that cloud.
    std::vector<LoadItem> items(const CloudLoader& cloud) const;
    // The bytes of a node, or why there are none. Answers whatever was asked about it.
    void takeLoaded(const CloudLoader& cloud, std::uint32_t node, const Result<Bytes>& bytes);
    // Answers what is asked of a cloud that is gone.
    void cancel(CloudId cloud);

    bool pending() const { return !asked_.empty(); }
    // The answers since the last call, each exactly once.
    std::vector<PointAnswer> take() { return std::exchange(answers_, {}); }

  private:
    struct Question {
        PointIdentity point;
        std::uint32_t node; // index in the hierarchy
    };
    std::vector<Question> asked_;
    std::vector<PointAnswer> answers_;
};

// The point's integers and world coordinates, without reading anything. `node` holds it.
PointRecord positionRecord(const CloudMetadata& metadata, const ResidentNode& node, std::uint32_t index);

} // namespace stipple
