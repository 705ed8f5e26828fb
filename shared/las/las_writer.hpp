// Writes LAS files: point formats 0-10. The output gets its name only when finish() succeeds.
#pragma once

#include "shared/base/result.hpp"
#include "shared/las/las_header.hpp"
#include "shared/points/point_batch.hpp"

#include <memory>
#include <string>

namespace stipple::las {

struct WriterOptions {
    Grid grid;
    Schema schema;        // attributes with LAS names go to their fields, all others to extra bytes
    int pointFormat = -1; // -1: the smallest format that holds every attribute with a LAS name
    int versionMinor =
        -1; // -1: the lowest version that allows the format (1.2, 1.3, 1.4), 1.4 for > 2^32 - 1 points
    std::string wkt;       // written as the OGC WKT record; empty: none
    std::vector<Vlr> vlrs; // further records, copied as they are (not: WKT, extra bytes)
    std::string systemIdentifier = "stipple";
    std::uint16_t globalEncoding = 0; // the WKT bit is set by the writer
};

class Writer {
  public:
    // Errors: outputs that can't be made (ioFailed), a schema that no format holds (invalidArgument).
    static Result<std::unique_ptr<Writer>> create(const std::string& path, const WriterOptions& options);
    virtual ~Writer() = default; // without finish(): removes the temporary file

    // Appends points. outOfRange if an integer does not fit 32 bits or a value its field
    // (e.g. return number 9 in format 1).
    virtual Status write(const PointBatch& batch) = 0;
    // Writes counts, bounds and EVLRs, closes and renames.
    virtual Status finish() = 0;
    virtual const Header& header() const = 0;
};

} // namespace stipple::las
