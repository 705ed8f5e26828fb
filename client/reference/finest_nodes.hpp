// How fine a cloud is where a point lies, looked up level by level: what adaptive sizes
// (client/core/style.hpp) are where everything is drawn.
#pragma once

#include "shared/format/cloud_file.hpp"

#include <unordered_set>
#include <vector>

namespace stipple::reference {

class FinestNodes {
  public:
    // Reads the whole hierarchy. Errors: those of reading it.
    static Result<FinestNodes> of(CloudReader& reader);

    // Per point: the spacing of the finest node with points that holds it, world units.
    std::vector<double> spacingsAt(const PointBatch& points) const;

  private:
    int levelAt(const Vec3i& position) const;

    RootCube cube_;
    double rootSpacing_ = 0;
    int deepest_ = 0;
    std::unordered_set<NodeKey, NodeKeyHash> keys_; // of nodes with points
};

} // namespace stipple::reference
