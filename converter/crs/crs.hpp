// Which coordinate reference system a scan is in.
//
// PROJ's database (proj.db, Debian package proj-data) must be there: where it is not, every call answers
// ioFailed and says so. Thread: any; each call has a PROJ context of its own.
#pragma once

#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/las/las_header.hpp"

#include <string>
#include <vector>

namespace stipple {

struct CrsReading {
    Crs crs;                           // unknown where the file has none, or none that can be understood
    std::vector<std::string> warnings; // what in its records is broken, a sentence each
};

// The CRS of a LAS file, from its OGC WKT record (2112) or its GeoTIFF keys (34735-34737); the math
// transform record (2111) is ignored. LAS 1.4 says by a bit of its header that WKT holds; without that bit
// (and before 1.4) keys that name a system by its code hold, then WKT, then keys that spell one out. A
// record can be broken in any way: that is a warning, never an error.
Result<CrsReading> crsOfLas(const las::Header& header);

// The CRS a user names: "EPSG:26910", "EPSG:6339+5703", WKT 1 or 2, a PROJ string, or a name that PROJ's
// database knows. invalidArgument if it is none of these.
Result<Crs> crsFromUser(const std::string& text);

// The WKT of an EPSG code. Errors: those of crsFromUser().
Result<std::string> wktOfEpsg(int code);

} // namespace stipple
