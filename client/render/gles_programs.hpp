// The programs of the OpenGL ES renderer, and where their uniforms are.
#pragma once

#include "client/render/gles_objects.hpp"
#include "client/render/raster_setup.hpp"

namespace stipple::gles {

// points.vert.glsl + points.frag.glsl with one set of defines, and where its uniforms are.
struct PointProgram {
    Program program;
    GLint cell, fraction, rowX, rowY, rowD, positionShift, colourSource, ramp;
    GLint deep, fractionBits, lowX, highX, lowY, highY, origin;
    GLint centre, nearFar, nearBits, depthShift, perspective, sizeByDistance, size64, worldSize64,
        sizeRange64, gradient;
    GLint rank, continuous, growth, falloff, leastDensity, sizeByDensity;

    static Result<PointProgram> make(bool lowWords, bool circle);
    void useFor(const RasterFrame& frame) const;
    void setNode(const RasterNode& node) const;
};

struct ResolveProgram {
    Program program;
    GLint colour, depth, nearBits, depthShift, neighbours, offsets, power;

    static Result<ResolveProgram> make();
    void useFor(const RasterFrame& frame, const EdlSetup& edl) const;
};

} // namespace stipple::gles
