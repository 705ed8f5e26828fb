// Writes LAS and LAZ files: point formats 0-10, LAS 1.0-1.4. The output gets its name only when finish()
// succeeds. LAS also goes where bytes can't be written again, such as the body of an HTTP answer, if what its
// header says of the points is known before.
//
// Thread: one at a time per writer. Memory: one block of packed records (about 1 MiB); for LAZ also the
// compressed bytes of a chunk of 50,000 points, and its models (about 2 MB); more with a ChunkWork
// (laz/chunk_writer.hpp).
#pragma once

#include "shared/base/result.hpp"
#include "shared/io/byte_sink.hpp"
#include "shared/las/chunk_work.hpp"
#include "shared/las/las_header.hpp"
#include "shared/las/las_reader.hpp"
#include "shared/las/point_summary.hpp"
#include "shared/points/point_batch.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stipple::las {

struct WriterOptions {
    Grid grid;
    // Attributes with LAS names go to their fields, all others to described extra bytes, in this order.
    // A LAS attribute that the format has no field for (GPS Time in format 0, Scan Angle Rank in format
    // 6) goes to extra bytes too, so nothing is lost.
    Schema schema;
    int pointFormat = -1; // -1: the smallest that holds every LAS attribute, or as many of them as can be
    // -1: the lowest that allows the format (1.2, 1.3, 1.4); 1.4 for WKT, described extra bytes, extended
    // records, or expectedPoints > 2^32 - 1
    int versionMinor = -1;
    std::uint64_t expectedPoints = 0; // 0: unknown
    // LAZ: pointwise chunks of version 2 for formats 0-5, layered ones of version 3 from format 6 on.
    bool compressed = false;
    // Makes who compresses the chunks of LAZ; null, or an answer of null: the thread that writes.
    std::function<std::unique_ptr<ChunkWork>()> makeChunkWork = nullptr;
    std::string wkt;       // written as the OGC WKT record; empty: none
    std::vector<Vlr> vlrs; // further records, copied as they are (not: WKT, extra bytes, LAZ)
    std::string systemIdentifier = "stipple";
    std::string generatingSoftware = "stipple";
    std::uint16_t globalEncoding = 0; // the WKT bit is set by the writer
    std::uint16_t fileSourceId = 0;
    std::array<std::uint8_t, 16> projectId{};
    std::uint16_t creationDay = 0, creationYear = 0; // 0: left open (same input, same bytes)
};

// Options that write a file like the one read: its grid, schema, format, version, records and identity,
// compressed if it is. Records whose data were left in the file (Vlr::omitted) are not among them.
WriterOptions optionsLike(const Reader& reader);

// What a summary of the points that such options write is made of: columns of options.schema. Errors: those
// of Writer::create.
Result<SummaryColumns> summaryColumnsFor(const WriterOptions& options);

class Writer {
  public:
    // Errors: outputs that can't be made (writeFailed); options that contradict themselves or LAS, such as an
    // "Intensity" that is no uint16 (invalidArgument).
    static Result<std::unique_ptr<Writer>> create(const std::string& path, const WriterOptions& options);
    // `stated`: of all points that will come. Where `to` can't be overwritten it is needed, and LAZ is
    // refused, for the place of its chunk table stands before the chunks (invalidArgument). The bytes are
    // those of a file.
    static Result<std::unique_ptr<Writer>> create(std::unique_ptr<ByteSink> to, const WriterOptions& options,
                                                  std::optional<PointSummary> stated = std::nullopt);
    virtual ~Writer() = default; // without finish(): removes the temporary file

    // Appends points. outOfRange if an integer does not fit 32 bits or a value its field
    // (e.g. return number 9 in format 1). After an error the file can't be finished.
    virtual Status write(const PointBatch& batch) = 0;
    // Writes counts, bounds and EVLRs, closes and renames. corrupt if the points are not those that were
    // stated where that has gone out already.
    virtual Status finish() = 0;
    // Counts and bounds are those of the points written so far.
    virtual const Header& header() const = 0;
    // What could not be written as asked, one sentence each: names cut to the 32 bytes LAS has.
    virtual const std::vector<std::string>& warnings() const = 0;
};

} // namespace stipple::las
