// Colours the pixels of a point; round points drop those whose centre lies outside the circle, except the
// pixel that holds the point (client/render/raster_setup.hpp, "Coverage").
// BLEND: adds the point's weighted colour where it lies within its blend depth of the nearest ("Splats").
// IDENTITY: which point it is instead of its colour, in a window of the picture (client/render/pick.hpp).
precision highp float;
precision highp int;
precision highp sampler2D;

flat in vec4 vColour;
#ifdef CENTRED
flat in ivec3 vRound;
#endif
#ifdef PARABOLOID
flat in vec2 vBend;
#endif
#ifdef DISC
flat in vec4 vPlane; // sprite.glsl
flat in vec4 vLean;
uniform float uPixelSlope;
#endif
#if defined(PARABOLOID) || defined(DISC)
uniform vec2 uNearFar;
uniform uint uNearBits;
uniform int uDepthShift;
#endif
#ifdef BLEND
#ifdef DISC
flat in float vBlendDepth;
#else
flat in uint vBlended;
#endif
uniform sampler2D uNearest; // depth of the nearest points
uniform int uHardness;
#endif

#ifdef IDENTITY
flat in uvec3 vPoint;
uniform ivec2 uWindow;                   // lower left pixel
layout(location = 0) out uvec4 outPoint; // node, point, depth step, 1
#else
layout(location = 0) out vec4 outColour;
#endif
#ifdef COLLECT
flat in uvec2 vPlace;
layout(location = 1) out uvec2 outPlace; // the second goes nowhere where no normals are kept
#endif

vec2 pixelCentre() {
#ifdef IDENTITY
    return gl_FragCoord.xy + vec2(uWindow);
#else
    return gl_FragCoord.xy;
#endif
}

#ifdef BLEND
// In 2^-16.
float weightAt(float away) {
    float base = max(1.0 - away, 0.0);
    float weight = base;
    for (int i = 1; i < uHardness; ++i)
        weight *= base;
    return (floor(weight * 65535.0) + 1.0) * (1.0 / 65536.0);
}
#endif

#ifdef DISC
// Where the pixel's ray meets the disc's plane (client/render/disc.hpp, meetDisc): the square of the distance from the
// point over that of the radius, and the view distance. Outside: (2, the point's distance).
vec2 meetDisc(ivec2 apart) {
    vec2 at = vec2(apart) * (1.0 / 256.0);
    float e = vLean.x * at.x + vLean.y * at.y;
    float w = vPlane.z + e * uPixelSlope;
    float alongX = vPlane.z * at.x - e * vPlane.x;
    float alongY = vPlane.z * at.y - e * vPlane.y;
    float square = (alongX * alongX + alongY * alongY) + e * e;
    float reach = vPlane.w * w;
    if (!(w > 0.0 && square <= reach * reach))
        return vec2(2.0, vLean.z);
    float plane = vLean.z - (e * vLean.w) * (1.0 / w);
    return vec2(square * (1.0 / (reach * reach)), min(max(plane, uNearFar.x), uNearFar.y));
}

uint stepOf(float distance) {
    return (floatBitsToUint(distance) - uNearBits) >> uDepthShift;
}
#endif

void main() {
#ifdef CENTRED
    ivec2 from = ivec2(pixelCentre() * 256.0) - vRound.xy;
    ivec2 apart = abs(from);
    bool holdsPoint = max(apart.x, apart.y) < 128;
    int away = apart.x * apart.x + apart.y * apart.y;
#ifdef CIRCLE
    if (!holdsPoint && away > vRound.z)
        discard;
#endif
#endif
#ifdef DISC
    vec2 met = meetDisc(from);
    if (!holdsPoint && met.x > 1.0)
        discard;
    uint planeStep = stepOf(met.y);
    gl_FragDepth = float(planeStep) * (1.0 / 16777216.0);
#endif
#ifdef PARABOLOID
    float bent = min(vBend.x + vBend.y * float(away), uNearFar.y);
    uint bentStep = (floatBitsToUint(bent) - uNearBits) >> uDepthShift;
    gl_FragDepth = float(bentStep) * (1.0 / 16777216.0);
#endif
#if defined(IDENTITY) && defined(PARABOLOID)
    outPoint = uvec4(vPoint.xy, bentStep, 1u);
#elif defined(IDENTITY) && defined(DISC)
    outPoint = uvec4(vPoint.xy, planeStep, 1u);
#elif defined(IDENTITY)
    outPoint = uvec4(vPoint, 1u);
#elif defined(BLEND)
    uint nearest = uint(texelFetch(uNearest, ivec2(gl_FragCoord.xy), 0).r * 16777216.0);
#ifdef DISC
    uint blended = stepOf(max(met.y - vBlendDepth, uNearFar.x));
    float weight = weightAt(met.x);
#else
    uint blended = vBlended;
    float weight = weightAt(float(away) / float(vRound.z));
#endif
    if (blended > nearest)
        discard;
    outColour = vec4(vColour.rgb * weight, weight);
#else
    outColour = vec4(vColour.rgb, 1.0);
#endif
#ifdef COLLECT
    outPlace = vPlace;
#endif
}
