// The programs of the OpenGL ES renderer, and where their uniforms are.
#pragma once

#include "client/render/gles_objects.hpp"
#include "client/render/pick.hpp"
#include "client/render/raster_setup.hpp"

#include <array>
#include <map>

namespace stipple::gles {

// What a point program is compiled for.
struct PointVariant {
    bool lowWords = false; // nodes with a third position word
    bool circle = false;
    bool paraboloid = false; // circle, too
    bool disc = false;       // never circle
    bool normals = false;    // looks at normals: discs, and what collects for them
    bool adaptive = false;
    bool growing = false;       // never adaptive
    bool blend = false;         // the pass of splats that blends
    bool collect = false;       // the first pass of delayed expansion
    bool expand = false;        // the second: expand.vert.glsl
    bool captureLevels = false; // adaptive; vLevels goes to transform feedback
    bool identity = false;      // writes which point a pixel shows (client/render/pick.hpp), not its colour

    bool walksOctree() const { return adaptive || growing; }
    friend auto operator<=>(const PointVariant&, const PointVariant&) = default;
    static PointVariant of(const RasterFrame& frame, const DrawNode& node);
};

// Texture units of the point programs.
inline constexpr int octreeUnit = 1, nearestUnit = 2, centreColoursUnit = 3, centreDepthsUnit = 4,
                     centrePlacesUnit = 5;
inline constexpr int centrePointsUnit = centreColoursUnit; // identities are written instead of colours

// points.vert.glsl + points.frag.glsl with one set of defines, and where its uniforms are.
struct PointProgram {
    Program program;
    GLint cell, fraction, rowX, rowY, rowD, positionShift;
    GLint deep, fractionBits, lowX, highX, lowY, highY, origin;
    GLint centre, part, nearFar, nearBits, depthShift, perspective, sizeByDistance, size64, worldSize64,
        sizeRange64;
    GLint rank, continuous, growth, falloff, leastDensity, sizeByDensity;

    GLint octree, octreePlace, nodeBits, nodeSize64;
    GLint radiusScale, blendFactor, nearest, hardness;
    GLint discAxes, pixelUnits, pixelSlope;
    GLint nodeIndex, window; // of programs that write identities
    GLint centreColours, centreDepths, centrePlaces, columns;
    GLint centrePoints, centreWindow; // of both

    static Program start(const PointVariant& variant); // waits for nothing
    static Result<PointProgram> finish(Program program);
    void useFor(const RasterFrame& frame) const;
    void setNode(const RasterNode& node) const;
    // Of programs that write identities: what stands for the node, and the window's lower left pixel.
    void setIdentity(std::uint32_t node, int left, int bottom) const;
    // The second pass of delayed expansion where identities are written: the window that the centres are in,
    // and the one that is written.
    void setIdentityWindows(const PictureWindow& centres, const PictureWindow& written) const;
    // Adaptive sizes: the node's place in the octree texture.
    void setOctreePlace(std::uint32_t place, const ResidentNode& node) const;
};

// Point programs, each made when it is first asked for.
class PointPrograms {
  public:
    void start(const PointVariant& variant); // one that will be asked for, without waiting for it
    Result<const PointProgram*> get(const PointVariant& variant);

  private:
    std::map<PointVariant, Program> started_;
    std::map<PointVariant, PointProgram> made_;
};

struct ResolveProgram {
    Program program;
    GLint colour, depth, background, nearBits, depthShift, neighbours, offsets, power;

    // `splats`: from sums of weighted colours.
    static Program start(bool splats);
    static Result<ResolveProgram> finish(Program program);
    void useFor(const RasterFrame& frame, const EdlSetup& edl,
                const std::array<std::uint8_t, 3>& backgroundColour) const;
};

} // namespace stipple::gles
