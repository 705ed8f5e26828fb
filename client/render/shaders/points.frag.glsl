// Colours the pixels of a point; round points drop those whose centre lies outside the circle, except the
// pixel that holds the point (client/render/raster_setup.hpp, "Coverage").
precision highp float;
precision highp int;

flat in vec4 vColour;
#ifdef CIRCLE
flat in ivec3 vDisc;
#endif

layout(location = 0) out vec4 outColour;

void main() {
#ifdef CIRCLE
    ivec2 away = abs(ivec2(gl_FragCoord.xy * 256.0) - vDisc.xy);
    bool holdsPoint = max(away.x, away.y) < 128;
    if (!holdsPoint && away.x * away.x + away.y * away.y > vDisc.z)
        discard;
#endif
    outColour = vec4(vColour.rgb, 1.0);
}
