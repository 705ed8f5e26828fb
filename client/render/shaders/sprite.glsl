// From a point's place in the picture to a square of the window, and what its pixels need to know of it: the end of
// points.vert.glsl and expand.vert.glsl. The rules: client/render/raster_setup.hpp.
// Defined before this text: CENTRED where pixels need the point's middle; PARABOLOID; BLEND in the pass of splats that blends.
precision highp float;
precision highp int;

uniform vec2 uCentre; // half the picture, pixels
uniform vec2 uNearFar;
uniform uint uNearBits;
uniform int uDepthShift;
uniform bool uPerspective;

flat out vec4 vColour;
#ifdef CENTRED
flat out ivec3 vDisc; // centre in 1/256 pixel, squared radius in (1/256 pixel)²
#endif
#ifdef PARABOLOID
flat out vec2 vBend; // raster_setup.hpp, "Paraboloid": distance, and what is added by (1/256 pixel)²
#endif
#if defined(BLEND) || defined(PARABOLOID)
uniform float uRadiusScale;
#endif
#ifdef BLEND
uniform float uBlendFactor;
flat out uint vBlended; // blended step
#endif

// What is outside the clip volume is not drawn: beyond the far plane.
void discardPoint() {
    gl_PointSize = 1.0;
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
#ifdef CENTRED
    vDisc = ivec3(0, 0, 1);
#endif
#ifdef PARABOLOID
    vBend = vec2(1.0, 0.0);
#endif
#ifdef BLEND
    vBlended = 0xFFFFFFFFu;
#endif
}

float distanceOfStep(uint step) {
    return uintBitsToFloat((step << uDepthShift) + uNearBits);
}

// Half the size in world units.
#if defined(BLEND) || defined(PARABOLOID)
float radiusOf(float size64, float distance) {
    float radius = size64 * uRadiusScale;
    return uPerspective ? radius * distance : radius;
}
#endif

// cell: 1/128 pixel; step: of depth.
void placePoint(ivec2 cell, float size64, uint step) {
    gl_PointSize = size64 * (1.0 / 64.0);
#ifdef CENTRED
    int radius = 2 * int(size64);
    vDisc = ivec3(2 * cell + 1, radius * radius);
#endif
#ifdef PARABOLOID
    float middle = distanceOfStep(step), half256 = float(2 * int(size64));
    vBend = vec2(middle, size64 > 64.0 ? radiusOf(size64, middle) / (half256 * half256) : 0.0);
#endif
#ifdef BLEND
    float distance = distanceOfStep(step);
    float back = distance - (radiusOf(size64, distance) + uBlendFactor * distance);
    vBlended = (floatBitsToUint(max(back, uNearFar.x)) - uNearBits) >> uDepthShift;
#endif
    // Middle of the cell in normalised device coordinates, w = 1: nothing is divided after this.
    vec2 snapped = (vec2(cell) + 0.5) * (1.0 / 128.0);
    gl_Position = vec4((snapped - uCentre) / uCentre, float(step) * (1.0 / 8388608.0) - 1.0, 1.0);
}
