// From a point's place in the picture to a square of the window, and what its pixels need to know of it: the end of
// points.vert.glsl and expand.vert.glsl. The rules: client/render/raster_setup.hpp.
// Defined before this text: CENTRED where pixels need the point's middle; PARABOLOID; DISC for points with normals (the rules:
// client/render/disc.hpp); BLEND in the pass of splats that blends.
precision highp float;
precision highp int;

uniform vec2 uCentre; // half the picture, pixels
uniform ivec4 uPart;  // what is drawn of it: first pixel, size
uniform vec2 uNearFar;
uniform uint uNearBits;
uniform int uDepthShift;
uniform bool uPerspective;

flat out vec4 vColour;
#ifdef CENTRED
flat out ivec3 vRound; // centre in 1/256 pixel, squared radius in (1/256 pixel)²
#endif
#ifdef PARABOLOID
flat out vec2 vBend; // raster_setup.hpp, "Paraboloid": distance, and what is added by (1/256 pixel)²
#endif
#ifdef DISC
uniform mat3 uDiscAxes;    // columns: the camera's right, up, forward, over 32767
uniform float uPixelUnits; // world units that a pixel spans at distance 1
uniform float uPixelSlope;
flat out vec4 vPlane; // slopes of the point's ray, c, radius in pixels
flat out vec4 vLean;  // x and y of the normal, distance, units a pixel
#endif
#if defined(BLEND) || defined(PARABOLOID)
uniform float uRadiusScale;
#endif
#ifdef BLEND
uniform float uBlendFactor;
#ifdef DISC
flat out float vBlendDepth;
#else
flat out uint vBlended; // blended step
#endif
#endif

// What is outside the clip volume is not drawn: beyond the far plane.
void discardPoint() {
    gl_PointSize = 1.0;
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
#ifdef CENTRED
    vRound = ivec3(0, 0, 1);
#endif
#ifdef PARABOLOID
    vBend = vec2(1.0, 0.0);
#endif
#ifdef DISC
    vPlane = vec4(0.0, 0.0, 1.0, 0.0);
    vLean = vec4(0.0, 0.0, 1.0, 1.0);
#endif
#if defined(BLEND) && defined(DISC)
    vBlendDepth = 0.0;
#elif defined(BLEND)
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

#ifdef DISC
const float mostReach = 127.5; // pixels
const float leastFacing = 1e-5;

// A vector in the direction of a normal's word (client/core/node_normals.hpp); |x| + |y| + |z| is 32767.
ivec3 normalOfWord(uint word) {
    ivec2 at = ivec2(int(word << 16) >> 16, int(word) >> 16);
    ivec2 away = abs(at);
    int z = 32767 - away.x - away.y;
    if (z >= 0)
        return ivec3(at, z);
    ivec2 folded = ivec2(32767) - away.yx;
    return ivec3(at.x < 0 ? -folded.x : folded.x, at.y < 0 ? -folded.y : folded.y, z);
}

float reachAlong(float lean, float slope, float nz, float inverse, float grows) {
    float along = lean - nz * slope, whole = 1.0 + slope * slope;
    float across = max(whole - along * along * inverse, 0.0) + 1e-5 * whole;
    return min(vPlane.w * sqrt(across) * grows + 0.015625, mostReach);
}

// How far from the point its disc reaches, pixels.
float discReach(float nz, float lengthSquared) {
    float inverse = 1.0 / lengthSquared, tilt = max(1.0 - nz * nz * inverse, 0.0);
    float nearest = 1.0 - vPlane.w * uPixelSlope * sqrt(tilt + 1e-5);
    float grows = 1.0 / max(nearest, 1e-6);
    return max(reachAlong(vLean.x, vPlane.x, nz, inverse, grows), reachAlong(vLean.y, vPlane.y, nz, inverse, grows));
}

// Sets vPlane and vLean; answers the size of the square that holds the disc, pixels.
float discOf(ivec2 middle, float size64, float distance, uint word) {
    vec2 slopes = (vec2(middle) * (1.0 / 256.0) - uCentre) * uPixelSlope;
    vec3 n = vec3(0.0, 0.0, 1.0);
    if (word != 0x80008000u) {
        vec3 whole = vec3(normalOfWord(word));
        n.x = (whole.x * uDiscAxes[0].x + whole.y * uDiscAxes[0].y) + whole.z * uDiscAxes[0].z;
        n.y = (whole.x * uDiscAxes[1].x + whole.y * uDiscAxes[1].y) + whole.z * uDiscAxes[1].z;
        n.z = (whole.x * uDiscAxes[2].x + whole.y * uDiscAxes[2].y) + whole.z * uDiscAxes[2].z;
    }
    float facing = size64 > 64.0 ? (n.x * slopes.x + n.y * slopes.y) + n.z : 0.0; // single pixels are flat
    if (facing < 0.0) {
        n = -n;
        facing = -facing;
    }
    float units = uPerspective ? uPixelUnits * distance : uPixelUnits;
    if (!(facing > leastFacing)) {
        vPlane = vec4(slopes, 1.0, 0.0);
        vLean = vec4(0.0, 0.0, distance, units);
        return 1.0;
    }
    vPlane = vec4(slopes, facing, size64 * (0.5 / 64.0));
    vLean = vec4(n.xy, distance, units);
    return clamp(2.0 * discReach(n.z, (n.x * n.x + n.y * n.y) + n.z * n.z), 1.0, 255.0);
}
#endif

// cell: 1/128 pixel of the whole picture; step: of depth; word: of its normal, for DISC.
void placePoint(ivec2 cell, float size64, uint step, uint word) {
    gl_PointSize = size64 * (1.0 / 64.0);
#ifdef CENTRED
    int radius = 2 * int(size64);
    vRound = ivec3(2 * (cell - 128 * uPart.xy) + 1, radius * radius);
#endif
#ifdef PARABOLOID
    float middle = distanceOfStep(step), half256 = float(2 * int(size64));
    vBend = vec2(middle, size64 > 64.0 ? radiusOf(size64, middle) / (half256 * half256) : 0.0);
#endif
#ifdef DISC
    gl_PointSize = discOf(2 * cell + 1, size64, distanceOfStep(step), word);
#endif
#ifdef BLEND
    float distance = distanceOfStep(step);
    float blendDepth = radiusOf(size64, distance) + uBlendFactor * distance;
#endif
#if defined(BLEND) && defined(DISC)
    vBlendDepth = blendDepth;
#elif defined(BLEND)
    float back = distance - blendDepth;
    vBlended = (floatBitsToUint(max(back, uNearFar.x)) - uNearBits) >> uDepthShift;
#endif
    // Middle of the cell in normalised device coordinates, w = 1: nothing is divided after this.
    vec2 snapped = (vec2(cell - 128 * uPart.xy) + 0.5) * (1.0 / 128.0), halfPart = vec2(uPart.zw) * 0.5;
    gl_Position = vec4((snapped - halfPart) / halfPart, float(step) * (1.0 / 8388608.0) - 1.0, 1.0);
}
