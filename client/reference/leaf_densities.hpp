// How much denser each further point makes a leaf, for levels of points (client/core/continuous_detail.hpp).
// A leaf holds what its ancestors left, so it may be denser than its level. Its parent's N points fill the
// surface at the parent's spacing; the leaf has one of the k shares that the parent's children make of it.
#pragma once

#include "shared/format/cloud_file.hpp"

#include <unordered_map>

namespace stipple::reference {

class LeafDensities {
  public:
    // Reads the whole hierarchy. Errors: those of reading it.
    static Result<LeafDensities> of(CloudReader& reader);

    // In points of the level above on the same area; 0: the node is no leaf, or has no parent with points.
    double stepOf(const NodeKey& key) const;

  private:
    struct Known {
        double points = 0;
        int children = 0;
    };
    std::unordered_map<NodeKey, Known, NodeKeyHash> nodes_;
};

} // namespace stipple::reference
