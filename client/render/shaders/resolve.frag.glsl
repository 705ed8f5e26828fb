// Copies the picture of the points to the target, shaded by eye-dome lighting (Potree thesis §4.4; the form
// used here: EdlSetup in client/render/raster_setup.hpp). uNeighbours 0: plain copy.
precision highp float;
precision highp int;
precision highp sampler2D;

uniform sampler2D uColour; // SPLATS: sums of weighted colours and, in alpha, of weights
uniform vec3 uBackground;
uniform sampler2D uDepth;
uniform uint uNearBits;
uniform int uDepthShift;
uniform int uNeighbours;
uniform ivec2 uOffsets[8];
uniform float uPower;

layout(location = 0) out vec4 outColour;

// View distance of the pixel's point; 0 where there is none.
float distanceAt(ivec2 at) {
    ivec2 size = textureSize(uDepth, 0);
    if (at.x < 0 || at.y < 0 || at.x >= size.x || at.y >= size.y)
        return 0.0;
    float depth = texelFetch(uDepth, at, 0).r;
    if (depth >= 1.0)
        return 0.0;
    return uintBitsToFloat((uint(depth * 16777216.0) << uDepthShift) + uNearBits);
}

float shadeOf(ivec2 at) {
    float distance = distanceAt(at);
    if (distance == 0.0)
        return 1.0;
    float product = 1.0;
    for (int i = 0; i < uNeighbours; ++i) {
        float neighbour = distanceAt(at + uOffsets[i]);
        product *= max(1.0, neighbour > 0.0 ? distance * (1.0 / neighbour) : 1.0);
    }
    return product > 1.0 ? exp2(-log2(min(product, 1e30)) * uPower) : 1.0;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
#ifdef SPLATS
    vec4 sums = texelFetch(uColour, at, 0);
    vec3 colour = sums.a > 0.0 ? sums.rgb / sums.a : uBackground;
#else
    vec3 colour = texelFetch(uColour, at, 0).rgb;
#endif
    float shade = uNeighbours > 0 ? shadeOf(at) : 1.0;
    outColour = vec4(colour * shade, 1.0);
}
