// Colours the pixels of a point; round points drop those whose centre lies outside the circle, except the
// pixel that holds the point (client/render/raster_setup.hpp, "Coverage").
// BLEND: adds the point's weighted colour where it lies within its blend depth of the nearest ("Splats").
// IDENTITY: which point it is instead of its colour, in a window of the picture (client/render/pick.hpp).
precision highp float;
precision highp int;
precision highp sampler2D;

flat in vec4 vColour;
#ifdef CENTRED
flat in ivec3 vDisc;
#endif
#ifdef PARABOLOID
flat in vec2 vBend;
uniform vec2 uNearFar;
uniform uint uNearBits;
uniform int uDepthShift;
#endif
#ifdef BLEND
flat in uint vBlended;
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
flat in uint vPlace;
layout(location = 1) out uint outPlace;
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
float weightAt(int away) {
    float base = max(1.0 - float(away) / float(vDisc.z), 0.0);
    float weight = base;
    for (int i = 1; i < uHardness; ++i)
        weight *= base;
    return (floor(weight * 65535.0) + 1.0) * (1.0 / 65536.0);
}
#endif

void main() {
#ifdef CENTRED
    ivec2 apart = abs(ivec2(pixelCentre() * 256.0) - vDisc.xy);
    int away = apart.x * apart.x + apart.y * apart.y;
#ifdef CIRCLE
    bool holdsPoint = max(apart.x, apart.y) < 128;
    if (!holdsPoint && away > vDisc.z)
        discard;
#endif
#endif
#ifdef PARABOLOID
    float bent = min(vBend.x + vBend.y * float(away), uNearFar.y);
    uint bentStep = (floatBitsToUint(bent) - uNearBits) >> uDepthShift;
    gl_FragDepth = float(bentStep) * (1.0 / 16777216.0);
#endif
#if defined(IDENTITY) && defined(PARABOLOID)
    outPoint = uvec4(vPoint.xy, bentStep, 1u);
#elif defined(IDENTITY)
    outPoint = uvec4(vPoint, 1u);
#elif defined(BLEND)
    uint nearest = uint(texelFetch(uNearest, ivec2(gl_FragCoord.xy), 0).r * 16777216.0);
    if (vBlended > nearest)
        discard;
    float weight = weightAt(away);
    outColour = vec4(vColour.rgb * weight, weight);
#else
    outColour = vec4(vColour.rgb, 1.0);
#endif
#ifdef COLLECT
    outPlace = vPlace;
#endif
}
