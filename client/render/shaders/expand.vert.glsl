// The second pass of delayed expansion (client/render/raster_setup.hpp, "Expansion"): the point that each pixel's centre
// pass kept becomes a square of its size at its exact place. One vertex a pixel, from left to right, rows from the
// bottom. Before this text: that of sprite.glsl.
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;

uniform sampler2D uCentreColours;
uniform sampler2D uCentreDepths;
uniform usampler2D uCentrePlaces; // cell in its pixel: x, y << 7; size << 14, 1/64 pixel
uniform int uColumns;             // of the picture

void main() {
    ivec2 pixel = ivec2(gl_VertexID % uColumns, gl_VertexID / uColumns);
    float depth = texelFetch(uCentreDepths, pixel, 0).r;
    vColour = texelFetch(uCentreColours, pixel, 0);
    if (depth >= 1.0) {
        discardPoint();
        return;
    }
    uint place = texelFetch(uCentrePlaces, pixel, 0).r;
    ivec2 cell = pixel * 128 + ivec2(uvec2(place, place >> 7) & 127u);
    placePoint(cell, float(place >> 14), uint(depth * 16777216.0));
}
