// From one coordinate reference system to another, by PROJ, in double precision.
//
// One operation, the best that PROJ's database and the installed grids have for the area, transforms all
// points: a choice per point would tear a scan where the choice changes. x is east and y north on both
// sides, whatever order the definitions have (proj_normalize_for_visualization).
//
// Heights. Both systems define them (compound, three-dimensional, geocentric): they are transformed. One of
// them does not: the other's heights are left out of account and z stays as it is. Geocentric coordinates
// have no height of their own: the other system's are then taken for metres above its ellipsoid.
//
// No network: grids come from the disk alone.
#pragma once

#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/geometry/box.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

namespace stipple {

// Transforms on one thread.
class CrsTransformer {
  public:
    virtual ~CrsTransformer() = default;
    // In place; the three coordinates of a point that can't be transformed become infinite.
    virtual void transform(double* x, double* y, double* z, std::size_t count) = 0;
};

class CrsTransformation {
  public:
    struct Facts {
        std::string operation;                // PROJ's name for it
        std::optional<double> accuracyMeters; // as PROJ's database states it; 0: exact; nothing: unknown
        bool isBallpark = false;              // a shift of datum is left out, as PROJ knows none
        bool keepsHeights = false;            // z comes out as it went in
    };

    // `area`: what is going to be transformed, in coordinates of `from`; empty where unknown. Errors:
    // unsupported (PROJ knows no way), those of PROJ's database. Takes some tenths of a second.
    static Result<std::shared_ptr<const CrsTransformation>> create(const Crs& from, const Crs& to,
                                                                   const BoxD& area);
    virtual ~CrsTransformation() = default;

    virtual const Facts& facts() const = 0;
    // Thread: any. A transformer is given back by letting it go and used again; it must not outlive this.
    virtual Result<std::unique_ptr<CrsTransformer>> transformer() const = 0;
};

// "NAD83 / UTM zone 10N (EPSG:26910)", or what there is of it.
std::string crsTitle(const Crs& crs);

} // namespace stipple
