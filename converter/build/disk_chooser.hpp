// Poisson-disk sampling (chooser.hpp): points are visited in bit-reversed Morton order, block by block, which
// spreads them evenly, and taken if none taken before is too near. A node keeps its distance from what nodes
// that were sampled before it took near the common border, in its own subtree and in neighbouring ones.
#pragma once

#include "converter/build/chooser.hpp"
#include "converter/build/disk_thinning.hpp"

namespace stipple {

class DiskChooser : public Chooser {
  public:
    DiskChooser(const Subtree& subtree, const Spacing& spacing, std::span<const Borders* const> neighbours,
                int workers, bool wantsRepresentatives);

    bool heedsNeighbours() const override { return true; }
    void choose(const Candidates& candidates, int worker, std::span<std::uint32_t> representatives) override;
    void finishLevel(std::size_t begin, std::size_t end) override;
    Borders takeBorders() override { return std::move(outer_); }

  private:
    int nodeBits(std::size_t node) const;
    void blockNeighbours(const NodeKey& node, DiskThinning& thinning) const;
    void block(const std::vector<Vec3i>& borders, Vec3i corner, int bits, DiskThinning& thinning) const;
    bool reaches(Vec3i p, std::int64_t side, double squaredDistance) const;

    const Subtree& subtree_;
    const Spacing& spacing_;
    std::span<const Borders* const> neighbours_;
    std::vector<DiskThinning> thinnings_; // one for each worker
    const bool wantsRepresentatives_;
    std::unordered_map<NodeKey, std::size_t, NodeKeyHash> indexOf_;
    std::vector<std::vector<Vec3i>> borders_; // by node: taken points near its faces; of the level at work
    Borders outer_;
};

} // namespace stipple
