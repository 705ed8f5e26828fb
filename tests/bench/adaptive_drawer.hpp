// Points of adaptive sizes with OpenGL ES, either way: sizes by the octree texture, as GlesRenderer has them,
// or by dynamic batching. Programs, buffers and uniforms are the renderer's; so is the loop, but for what a
// pass beside it would add. For batching_bench and its test.
#pragma once

#include "client/render/gles_nodes.hpp"
#include "client/render/gles_octree.hpp"
#include "client/render/gles_programs.hpp"
#include "tests/bench/point_batches.hpp"

#include <cstdint>

namespace stipple {

// A GL context must be current for as long as it lives. Styles: adaptive sizes, neither splats nor lighting.
class AdaptiveDrawer {
  public:
    Status drawByOctree(const FramePlan& plan, unsigned target);
    Status drawBatches(const PointBatches& batches, unsigned target);

    // Of nodes or lists, and of the octree texture.
    std::uint64_t gpuBytes() const { return nodes_.bytes() + octree_.bytes(); }

  private:
    gles::PointPrograms programs_;
    gles::NodeBuffers nodes_;
    gles::OctreeTexture octree_;
};

} // namespace stipple
