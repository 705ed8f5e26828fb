// The parameters of /clouds/{id}/statistics: which points, as for /points, and what of them.
#pragma once

#include "server/api/points_parameters.hpp"

#include <array>

namespace stipple::server {

inline constexpr std::uint64_t maxBins = 10'000;
inline constexpr Parameter binsParameter{
    .name = "bins",
    .description =
        "Counts values in so many intervals of equal width: of attributes, from the least to the largest "
        "value "
        "in the cloud; of coordinates, over the part of the cloud's bounds that the region reaches. Without "
        "it, only values of which there are at most 256 are counted, one by one.",
    .kind = ParameterKind::count,
    .least = 1,
    .most = static_cast<double>(maxBins),
    .example = "20",
};

inline constexpr std::array statisticsParameters{
    boxParameter,     centerParameter,     sizeParameter, rotationParameter, polygonParameter,
    regionParameter,  minZParameter,       maxZParameter, classParameter,    whereParameter,
    spacingParameter, attributesParameter, binsParameter, versionParameter};

} // namespace stipple::server
