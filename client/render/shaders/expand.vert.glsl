// The second pass of delayed expansion (client/render/raster_setup.hpp, "Expansion"): the point that each pixel's centre
// pass kept becomes a square of its size at its exact place. One vertex a pixel, from left to right, rows from the
// bottom. Before this text: that of sprite.glsl; IDENTITY: of the points in a window, to tell which pixel shows which.
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;

#ifdef IDENTITY
uniform usampler2D uCentrePoints; // node, index in it, depth step, 1; 0: none
uniform ivec2 uCentreWindow;      // the pixel of the picture that they begin with
flat out uvec3 vPoint;
#else
uniform sampler2D uCentreColours;
uniform sampler2D uCentreDepths;
#endif
uniform usampler2D uCentrePlaces; // cell in its pixel: x, y << 7; size << 14, 1/64 pixel. Discs: the normal's word
uniform int uColumns;             // of the part, or of the window

void main() {
    ivec2 pixel = ivec2(gl_VertexID % uColumns, gl_VertexID / uColumns);
#ifdef IDENTITY
    uvec4 point = texelFetch(uCentrePoints, pixel, 0);
    vColour = vec4(1.0);
    vPoint = point.xyz;
    bool kept = point.w != 0u;
    uint step = point.z;
    ivec2 corner = (uCentreWindow + pixel) * 128;
#else
    float depth = texelFetch(uCentreDepths, pixel, 0).r;
    vColour = texelFetch(uCentreColours, pixel, 0);
    bool kept = depth < 1.0;
    uint step = uint(depth * 16777216.0);
    ivec2 corner = (uPart.xy + pixel) * 128;
#endif
    if (!kept) {
        discardPoint();
        return;
    }
    uvec2 place = texelFetch(uCentrePlaces, pixel, 0).rg;
    ivec2 cell = corner + ivec2(uvec2(place.r, place.r >> 7) & 127u);
    placePoint(cell, float(place.r >> 14), step, place.g);
}
