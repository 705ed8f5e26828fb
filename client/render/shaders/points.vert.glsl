// One point of a node to a square of the window. The rules are those of client/render/raster_setup.hpp,
// in the same order of operations as the software renderer.
// Before this text: that of sprite.glsl; defined: LOW_WORDS where the node has a third position word; ADAPTIVE or
// GROWING (with the text of octree.glsl) for sizes from the octree; NORMALS where they are looked at; COLLECT for the first pass of delayed expansion; CAPTURE_LEVELS to
// tell the level found there; IDENTITY where it is asked which point a pixel shows.
precision highp float;
precision highp int;

layout(location = 0) in uvec2 aPosition;
#ifdef LOW_WORDS
layout(location = 1) in uint aPositionLow;
#endif
layout(location = 2) in vec4 aColour; // alpha 0: hidden
#ifdef NORMALS
layout(location = 3) in uint aNormal; // a word of client/core/node_normals.hpp
#else
const uint aNormal = 0x80008000u; // none
#endif

uniform ivec3 uCell;
uniform vec3 uFraction;
uniform vec3 uRowX;
uniform vec3 uRowY;
uniform vec3 uRowD;
uniform int uPositionShift;
uniform bool uDeep;        // positions by integers (raster_setup.hpp, "Deep nodes")
uniform int uFractionBits;
uniform uvec3 uLowX;
uniform uvec3 uHighX;
uniform uvec3 uLowY;
uniform uvec3 uHighY;
uniform uvec2 uOrigin;
uniform vec2 uRank;        // raster_setup.hpp, "Detail": base, step

uniform bool uSizeByDistance;
uniform float uSize64;
uniform float uWorldSize64;
uniform vec2 uSizeRange64;
uniform bool uContinuous; // raster_setup.hpp, "Detail"
uniform float uGrowth;
uniform vec2 uFalloff;
uniform float uLeastDensity;
uniform bool uSizeByDensity;
#if defined(ADAPTIVE) || defined(GROWING)
uniform float uNodeSize64; // raster_setup.hpp, "Adaptive"
#endif

#ifdef COLLECT
flat out uvec2 vPlace; // expand.vert.glsl, uCentrePlaces
#endif
#ifdef CAPTURE_LEVELS
flat out int vLevels;
#endif
#ifdef IDENTITY
uniform uint uNode;
flat out uvec3 vPoint; // node, index in it, depth step
#endif

float along(vec3 row, vec3 r) {
    return (r.x * row.x + r.y * row.y) + r.z * row.z;
}

uint alongBits(uvec3 row, uvec3 s) {
    return row.x * s.x + row.y * s.y + row.z * s.z;
}

// The 1/128-pixel cell of a deep node's point, whose place in the picture `window` tells but roughly.
ivec2 deepCell(ivec3 steps, vec2 window) {
    ivec3 low = steps & 0xFFFF;
    ivec3 carry = low >> 15;
    uvec3 high = uvec3((steps >> 16) + carry);
    uvec3 rest = uvec3(low - (carry << 16));
    uvec2 exact = uOrigin + uvec2(alongBits(uLowX, rest) + alongBits(uHighX, high),
                                  alongBits(uLowY, rest) + alongBits(uHighY, high));
    ivec2 whole = ivec2(floor(window));
    return whole * 128 + (ivec2(exact - (uvec2(whole) << uFractionBits)) >> (uFractionBits - 7));
}

void main() {
    uvec3 p = uvec3(aPosition.x & 0x1FFFFFu, (aPosition.x >> 21) | ((aPosition.y << 10) & 0x1FF800u),
                    aPosition.y >> 11);
#ifdef LOW_WORDS
    uint lowMask = (1u << uPositionShift) - 1u;
    p = (p << uPositionShift) |
        (uvec3(aPositionLow, aPositionLow >> 10, aPositionLow >> 20) & uvec3(lowMask));
#endif
    ivec3 steps = ivec3(p) - uCell;
    vec3 r = vec3(steps) - uFraction;

    float d = along(uRowD, r);
    vColour = aColour;
#ifdef IDENTITY
    vPoint = uvec3(0u);
#endif
#if defined(ADAPTIVE) || defined(GROWING)
    ivec2 levels = walkOctree(p);
#ifdef CAPTURE_LEVELS
    vLevels = levels.x;
#endif
#endif
    if (aColour.a == 0.0 || !(d >= uNearFar.x && d <= uNearFar.y)) {
        discardPoint();
        return;
    }
    float inverse = 1.0 / d;
    float scale = uPerspective ? inverse : 1.0;
    vec2 window = vec2(along(uRowX, r), along(uRowY, r)) * scale;
    float density = 1.0, grown = 1.0;
    if (uContinuous) {
        vec2 off = window * uFalloff;
        density = clamp(1.0 - sqrt(off.x * off.x + off.y * off.y), uLeastDensity, 1.0);
        float q = (uRank.x + uRank.y * float(gl_VertexID)) / (density * density);
        q = uPerspective ? q * (d * d) : q;
        if (!(q < 1.0)) {
            discardPoint();
            return;
        }
        grown = clamp((1.0 - q) * uGrowth, 0.0, 1.0);
    }
    window = window + uCentre;
    window = clamp(window, vec2(-65536.0), vec2(65536.0));
    ivec2 cell = uDeep ? deepCell(steps, window) : ivec2(floor(window * 128.0));

    float size64 = uSize64;
#ifdef ADAPTIVE
    float fineness = uintBitsToFloat(uint(127 - levels.x) << 23);
    size64 = clamp(uNodeSize64 * fineness * scale + 0.5, uSizeRange64.x, uSizeRange64.y);
#else
    if (uSizeByDistance)
        size64 = clamp(uWorldSize64 * inverse + 0.5, uSizeRange64.x, uSizeRange64.y);
    else if (uSizeByDensity)
        size64 = clamp(uSize64 / density, uSizeRange64.x, uSizeRange64.y);
#ifdef GROWING
    float apart = uNodeSize64 * uintBitsToFloat(uint(127 - levels.x) << 23) * scale;
    float most = size64 * uintBitsToFloat(uint(127 + min(levels.y - levels.x, MAX_DOUBLINGS)) << 23);
    size64 = clamp(min(apart, most), size64, uSizeRange64.y);
#endif
#endif
    if (uContinuous)
        size64 = clamp(size64 * grown, 64.0, uSizeRange64.y);
    uint step = (floatBitsToUint(d) - uNearBits) >> uDepthShift;
#ifdef IDENTITY
    vPoint = uvec3(uNode, uint(gl_VertexID), step);
#endif
#ifdef COLLECT
    vPlace = uvec2(uint(cell.x & 127) | uint(cell.y & 127) << 7 | uint(size64) << 14, aNormal);
    size64 = 64.0;
#endif
    placePoint(cell, floor(size64), step, aNormal);
}
