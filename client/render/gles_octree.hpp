// The octree of the drawn nodes as a texture (drawn_octree.hpp), for sizes that depend on it.
#pragma once

#include "client/render/drawn_octree.hpp"
#include "client/render/gles_objects.hpp"

#include <cstdint>

namespace stipple::gles {

class OctreeTexture {
  public:
    // Makes the tree of the plan's drawn nodes and binds its texture to octreeUnit. Nothing is uploaded where
    // the tree is the last one.
    void load(const FramePlan& plan);
    std::uint32_t placeOf(std::size_t node) const { return tree_.places[node]; } // index into plan.nodes

    std::uint64_t bytes() const { return 4ull * octreeTextureWidth * static_cast<unsigned>(rows_); }
    void clear();

  private:
    DrawnOctree tree_;
    Texture texture_;
    int rows_ = 0;
};

} // namespace stipple::gles
