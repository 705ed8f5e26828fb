#include "shared/las/las_header.hpp"

#include "shared/base/text.hpp"

#include <cmath>

namespace stipple::las {

std::optional<std::string> boundsContradiction(const Header& header, const BoxI& found) {
    if (found.empty())
        return std::nullopt;
    Vec3d low = header.grid.toWorld(found.min), high = header.grid.toWorld(found.max);
    for (int axis = 0; axis < 3; ++axis) {
        double step = header.grid.scale[axis];
        bool agrees = std::abs(header.bounds.min[axis] - low[axis]) <= step &&
                      std::abs(header.bounds.max[axis] - high[axis]) <= step;
        if (!agrees) // also where the header says NaN
            return cat("the header gives ", "xyz"[axis], " from ", header.bounds.min[axis], " to ",
                       header.bounds.max[axis], ", but the points lie from ", low[axis], " to ", high[axis]);
    }
    return std::nullopt;
}

std::string wktRecord(const Header& header) {
    for (const Vlr& vlr : header.vlrs) {
        if (!vlr.is(records::projection, records::wkt) || vlr.omitted)
            continue;
        std::string text(vlr.data.begin(), vlr.data.end());
        return text.substr(0, text.find('\0'));
    }
    return {};
}

} // namespace stipple::las
