// Reads LAS and LAZ files: point formats 0-10, LAS 1.0-1.4, all that LASzip compresses. Safe on untrusted
// bytes: memory is bounded by the batch size asked for and by what the file really holds, never by what it
// claims. LAZ takes besides: 16 bytes a chunk for where they are, the compressed bytes of one chunk (or 4 MiB
// of it), and about 2 MB of models.
//
// Thread: one at a time per reader. Several readers of one file, each with a source of its own, decode chunks
// of LAZ in parallel: each enters at one of chunkStarts().
#pragma once

#include "shared/io/byte_source.hpp"
#include "shared/las/las_header.hpp"
#include "shared/points/point_batch.hpp"

#include <memory>
#include <span>
#include <string>

namespace stipple::las {

class Reader {
  public:
    // Parses header, VLRs and EVLRs, and the chunk table of LAZ. `source` must outlive the reader. Errors:
    // corrupt, truncated, unsupported. Contradictions that can be resolved (counts, offsets, bounds, a chunk
    // table that is damaged) become warnings().
    static Result<std::unique_ptr<Reader>> open(ByteSource& source);
    virtual ~Reader() = default;

    // Another reader of the same file through `source`, without reading header, records or chunk table again:
    // it costs copies of header and schema. Errors: changed if the source has another size.
    virtual Result<std::unique_ptr<Reader>> openAnother(ByteSource& source) const = 0;

    virtual const Header& header() const = 0;
    // The attributes of the points, in record order; extra bytes described (by their VLR names) or as
    // one undescribed "Extra Bytes" attribute.
    virtual const Schema& schema() const = 0;
    // Points that are really there: header().pointCount, or fewer if the file ends before, or the chunk table
    // of LAZ lists fewer (a warning).
    virtual std::uint64_t pointCount() const = 0;
    // What in the file contradicts itself, one sentence each, with positions.
    virtual const std::vector<std::string>& warnings() const = 0;

    // Points at which reading may begin without decoding others before them: the first points of chunks,
    // ascending from 0. Empty: anywhere (LAS). LAZ files without chunks, or whose chunk table is lost, have
    // the first point alone.
    virtual std::span<const std::uint64_t> chunkStarts() const = 0;

    // Which attributes read() has to fill, by name; the columns of others may be zero. Layered LAZ (formats
    // 6-10) leaves the layers of the others undecoded; LAS and pointwise LAZ read all the same. Positions,
    // return numbers and scanner channel are always read.
    virtual void select(std::span<const std::string> attributes) = 0;

    // Points [first, first + count) into `batch` (resized; fewer where the file ends before). Positions are
    // the file's integers (Header::grid). LAZ: going on where the last read ended decodes nothing twice;
    // elsewhere the chunk is decoded from its start. Errors: outOfRange if first > pointCount(); truncated
    // and corrupt for LAZ chunks, then the batch is empty; those of the source.
    virtual Status read(std::uint64_t first, std::uint64_t count, PointBatch& batch) = 0;
};

// The attributes of point format `format` (0..10) in record order, without extra bytes.
Schema schemaOf(int pointFormat);

} // namespace stipple::las
