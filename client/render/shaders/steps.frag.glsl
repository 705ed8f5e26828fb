// Writes the depth steps of a picture (client/render/raster_setup.hpp, "Depth") so that they can be read back:
// 24 bits in R, G, B, from low to high; A is 1 where there is a point.
precision highp float;
precision highp int;
precision highp sampler2D;

uniform sampler2D uDepth;

layout(location = 0) out vec4 outStep;

void main() {
    float depth = texelFetch(uDepth, ivec2(gl_FragCoord.xy), 0).r;
    uint q = uint(min(depth, 1.0) * 16777216.0);
    vec3 bytes = vec3(uvec3(q, q >> 8, q >> 16) & uvec3(255u)) * (1.0 / 255.0);
    outStep = depth < 1.0 ? vec4(bytes, 1.0) : vec4(0.0);
}
