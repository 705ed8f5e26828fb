// The programs of the OpenGL ES renderer, and where their uniforms are.
#pragma once

#include "client/render/gles_objects.hpp"
#include "client/render/raster_setup.hpp"

#include <map>

namespace stipple::gles {

// What a point program is compiled for.
struct PointVariant {
    bool lowWords = false; // nodes with a third position word
    bool circle = false;
    bool adaptive = false;
    bool captureLevels = false; // adaptive; vLevels goes to transform feedback

    friend auto operator<=>(const PointVariant&, const PointVariant&) = default;
    static PointVariant of(const RasterFrame& frame, const ResidentNode& node);
};

// Texture units of the point programs.
inline constexpr int gradientUnit = 0, octreeUnit = 1;

// points.vert.glsl + points.frag.glsl with one set of defines, and where its uniforms are.
struct PointProgram {
    Program program;
    GLint cell, fraction, rowX, rowY, rowD, positionShift, colourSource, ramp;
    GLint deep, fractionBits, lowX, highX, lowY, highY, origin;
    GLint centre, nearFar, nearBits, depthShift, perspective, sizeByDistance, size64, worldSize64,
        sizeRange64, gradient;
    GLint rank, continuous, growth, falloff, leastDensity, sizeByDensity;

    GLint octree, octreePlace, nodeBits, nodeSize64;

    static Result<PointProgram> make(const PointVariant& variant);
    void useFor(const RasterFrame& frame) const;
    void setNode(const RasterNode& node) const;
    // Adaptive sizes: the node's place in the octree texture.
    void setOctreePlace(std::uint32_t place, const ResidentNode& node) const;
};

// Point programs, each made when it is first asked for.
class PointPrograms {
  public:
    Result<const PointProgram*> get(const PointVariant& variant);

  private:
    std::map<PointVariant, PointProgram> made_;
};

struct ResolveProgram {
    Program program;
    GLint colour, depth, nearBits, depthShift, neighbours, offsets, power;

    static Result<ResolveProgram> make();
    void useFor(const RasterFrame& frame, const EdlSetup& edl) const;
};

} // namespace stipple::gles
