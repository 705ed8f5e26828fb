// The parameters by which points of a cloud are chosen: /points, /profile, /nearest. All conditions given
// must hold. Coordinates are the cloud's.
#pragma once

#include "server/api/node_request.hpp"
#include "server/api/point_formats.hpp"
#include "server/api/validity.hpp"

#include <array>

namespace stipple::server {

inline constexpr double largestLength = 1e100, smallestLength = 1e-100; // half_space.hpp
inline constexpr double largestCount = 0x1p53;

inline constexpr Parameter boxParameter{
    .name = "box",
    .description = "Points in a box, its sides included: two corners, with heights or without.",
    .kind = ParameterKind::numbers,
    .form = "minx,miny,minz,maxx,maxy,maxz|minx,miny,maxx,maxy",
    .example = "-1e9,-1e9,1e9,1e9",
};
inline constexpr Parameter centerParameter{
    .name = "center",
    .description =
        "Points in a box that is turned, its sides included: its centre; without z, a box of any height.",
    .kind = ParameterKind::numbers,
    .form = "x,y,z|x,y",
    .example = "0,0",
    .needs = "size=1e6,1e6",
};
inline constexpr Parameter sizeParameter{
    .name = "size",
    .description = "The full sizes of the box around `center`, along its own axes.",
    .kind = ParameterKind::numbers,
    .form = "dx,dy,dz|dx,dy",
    .example = "2e7,2e7",
    .needs = "center=0,0",
};
inline constexpr Parameter rotationParameter{
    .name = "rotation",
    .description =
        "How the box around `center` is turned: degrees counter-clockwise about z, or a quaternion (x, y, z, "
        "w; of any length).",
    .kind = ParameterKind::numbers,
    .form = "degrees|x,y,z,w",
    .example = "30",
    .usual = "0",
    .needs = "center=0,0&size=2e7,2e7",
};
inline constexpr Parameter polygonParameter{
    .name = "polygon",
    .description =
        "Points in a region of the plane, its edges included: GeoJSON (Polygon, MultiPolygon, features of "
        "them), well-known text (POLYGON, MULTIPOLYGON), or the corners x,y;x,y;…",
    .example = "-1e7,-1e7;1e7,-1e7;0,1e7",
};
inline constexpr Parameter regionParameter{
    .name = "region",
    .description =
        "Points in a region as styles and scenes have it, its edges included: JSON with a polygon, its holes "
        "and "
        "heights, a line and its width, a prism (a polygon on the screen), or a box turned in any way.",
    .example = R"({"polygon": [[-1e7, -1e7], [1e7, -1e7], [0, 1e7]], "heights": [null, 1e6]})",
};
inline constexpr Parameter minZParameter{
    .name = "minz",
    .description = "Points of at least this height.",
    .kind = ParameterKind::number,
    .least = -largestLength,
    .most = largestLength,
    .example = "1.5",
};
inline constexpr Parameter maxZParameter{
    .name = "maxz",
    .description = "Points of at most this height.",
    .kind = ParameterKind::number,
    .least = -largestLength,
    .most = largestLength,
    .example = "1000",
};
inline constexpr Parameter classParameter{
    .name = "class",
    .description = "Points of these classes: numbers and ranges, such as 2,6 or 3-5. Of clouds that have "
                   "the attribute Classification.",
    .example = "2,6-9",
};
inline constexpr Parameter whereParameter{
    .name = "where",
    .description =
        "Points whose values lie in ranges: Attribute:low..high, several ranges joined by commas, several "
        "attributes by semicolons; either limit may be left out, and one value is a range. Of scaled "
        "attributes, the values they mean.",
    .example = "Intensity:10..20000,30000..",
};
inline constexpr Parameter spacingParameter{
    .name = "spacing",
    .description =
        "A level of detail: points of the levels whose minimum distance is at least this, leaves thinned to "
        "it. All points if not given.",
    .kind = ParameterKind::number,
    .least = smallestLength,
    .most = largestLength,
    .example = "2.5",
};
inline constexpr Parameter limitParameter{
    .name = "limit",
    .description =
        "The first so many of the points, in the order of the file: coarse nodes come first. All if not "
        "given.",
    .kind = ParameterKind::count,
    .least = 1,
    .most = largestCount,
    .example = "10",
};
inline constexpr Parameter lineParameter{
    .name = "line",
    .description = "The line of the profile: at least two points x,y;x,y;…",
    .example = "0,0;1,1",
    .isRequired = true,
};
inline constexpr Parameter widthParameter{
    .name = "width",
    .description =
        "The width of the profile: points within half of it on either side of the line, at any height.",
    .kind = ParameterKind::number,
    .least = smallestLength,
    .most = largestLength,
    .example = "1",
    .isRequired = true,
};
inline constexpr Parameter pointParameter{
    .name = "point",
    .description = "The points nearest to a place: in space, or without z in plan.",
    .kind = ParameterKind::numbers,
    .form = "x,y,z|x,y",
    .example = "0,0,0",
};
inline constexpr Parameter originParameter{
    .name = "origin",
    .description = "Instead of `point`: the first points along a ray that begins here.",
    .kind = ParameterKind::numbers,
    .form = "x,y,z",
    .example = "0,0,900",
    .needs = "direction=0,0,-1&radius=100",
};
inline constexpr Parameter directionParameter{
    .name = "direction",
    .description = "Where the ray goes; its length does not count.",
    .kind = ParameterKind::numbers,
    .form = "dx,dy,dz",
    .example = "0,0,-1",
    .needs = "origin=0,0,900&radius=100",
};
inline constexpr Parameter radiusParameter{
    .name = "radius",
    .description = "How far from the ray points may be.",
    .kind = ParameterKind::number,
    .least = 0,
    .most = largestLength,
    .example = "3",
    .needs = "origin=0,0,900&direction=0,0,-1",
};
inline constexpr Parameter angleParameter{
    .name = "angle",
    .description =
        "Instead of `radius`: how far from the ray points may be, seen from its origin, in degrees.",
    .kind = ParameterKind::number,
    .least = 0,
    .most = 80,
    .example = "0.5",
    .needs = "origin=0,0,900&direction=0,0,-1",
};
inline constexpr Parameter maxDistanceParameter{
    .name = "maxdistance",
    .description = "Points further from the place, or further along the ray, do not count.",
    .kind = ParameterKind::number,
    .least = 0,
    .most = largestLength,
    .example = "1e7",
};
inline constexpr Parameter countParameter{
    .name = "count",
    .description = "How many points.",
    .kind = ParameterKind::count,
    .least = 1,
    .most = 1000,
    .example = "3",
    .usual = "1",
};

inline constexpr std::array pointFileFormats{lasFormat, lazFormat, csvFormat, plyFormat};
inline constexpr auto pointFileFormatNames = namesOf(pointFileFormats);
inline constexpr Parameter pointFormatParameter{
    .name = "format",
    .description = "The format; if not given, what the field Accept wants most, else LAS.",
    .kind = ParameterKind::choice,
    .choices = pointFileFormatNames,
    .example = "csv",
};

inline constexpr std::array pointsParameters{
    boxParameter,     centerParameter, sizeParameter,       rotationParameter,    polygonParameter,
    regionParameter,  minZParameter,   maxZParameter,       classParameter,       whereParameter,
    spacingParameter, limitParameter,  attributesParameter, pointFormatParameter, versionParameter};
inline constexpr std::array profileParameters{
    lineParameter,       widthParameter,       boxParameter,    polygonParameter, minZParameter,
    maxZParameter,       classParameter,       whereParameter,  spacingParameter, limitParameter,
    attributesParameter, pointFormatParameter, versionParameter};
inline constexpr std::array nearestParameters{
    pointParameter,       originParameter, directionParameter, radiusParameter,     angleParameter,
    maxDistanceParameter, countParameter,  boxParameter,       polygonParameter,    minZParameter,
    maxZParameter,        classParameter,  whereParameter,     attributesParameter, versionParameter};

} // namespace stipple::server
