// Reads LAS files: point formats 0-10, LAS 1.0-1.4. Safe on untrusted bytes: memory is bounded by the
// batch size asked for and by what the file really holds, never by what it claims.
//
// Thread: one at a time per reader.
#pragma once

#include "shared/io/byte_source.hpp"
#include "shared/las/las_header.hpp"
#include "shared/points/point_batch.hpp"

#include <memory>
#include <span>

namespace stipple::las {

class Reader {
  public:
    // Parses header, VLRs and EVLRs. `source` must outlive the reader. Errors: corrupt, truncated,
    // unsupported. Contradictions that can be resolved (counts, offsets, bounds) become warnings().
    static Result<std::unique_ptr<Reader>> open(ByteSource& source);
    virtual ~Reader() = default;

    virtual const Header& header() const = 0;
    // The attributes of the points, in record order; extra bytes described (by their VLR names) or as
    // one undescribed "Extra Bytes" attribute.
    virtual const Schema& schema() const = 0;
    // Points that are really there: header().pointCount, or fewer if the file ends before (a warning).
    virtual std::uint64_t pointCount() const = 0;
    // What in the file contradicts itself, one sentence each, with positions.
    virtual const std::vector<std::string>& warnings() const = 0;

    // First points of the parts that can be entered without decoding what comes before (LAZ chunks), rising,
    // the first 0. Empty: reading can start anywhere.
    virtual std::span<const std::uint64_t> chunkStarts() const { return {}; }

    // Points [first, first + count) into `batch` (resized; fewer where the file ends before). Positions are
    // the file's integers (Header::grid). Errors: outOfRange if first > pointCount(), unsupported for LAZ
    // (whose header, records and schema can be read all the same), those of the source.
    virtual Status read(std::uint64_t first, std::uint64_t count, PointBatch& batch) = 0;
};

// The attributes of point format `format` (0..10) in record order, without extra bytes.
Schema schemaOf(int pointFormat);

} // namespace stipple::las
