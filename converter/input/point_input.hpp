// Where the points of a conversion come from: one file of any kind that is read, seen the same way.
//
//   openInput(path)  →  PointInput        what the file is: grid, schema, CRS, counts (input/open.hpp)
//   openPart(part)   →  PointStream       the points of one of its parts, batch by batch
//
// A file of floats or decimals is given a grid when it is opened (input/float_grid.hpp), so from here on
// points are integers. Files whose headers do not state their counts and bounds are read once when they are
// opened.
#pragma once

#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/geometry/box.hpp"
#include "shared/geometry/grid.hpp"
#include "shared/points/gps_time.hpp"
#include "shared/points/point_batch.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stipple {

// Points that a stream left out, by reason, and how far it had to move the others.
struct ReadReport {
    std::uint64_t notFinite = 0;       // a coordinate is NaN or infinite
    std::uint64_t outOfRange = 0;      // a coordinate is farther out than any grid could count
    std::uint64_t invalid = 0;         // marked invalid by the file itself (PTX "0 0 0", E57 invalid state)
    std::uint64_t untransformable = 0; // PROJ can't bring it into the cloud's CRS
    double maxRounding = 0; // largest distance from a stated coordinate to the grid, world units, per axis

    void add(const ReadReport& other);
    std::uint64_t dropped() const { return notFinite + outOfRange + invalid + untransformable; }
};

// What the GPS times of an input count from (LAS: global encoding, bit 0).
enum class GpsTimeKind : std::uint8_t { unknown, week, adjustedStandard };

struct InputDescription {
    std::string path;  // as given
    SourceFile source; // name, format in words, points to come (dropped ones not counted), size
    // Points that the file counts but does not hold: it was cut, or its header lies. Besides those to come.
    std::uint64_t lostPoints = 0;
    Grid grid;     // scales finite and > 0, offsets finite
    Schema schema; // names of LAS where the meaning is that of LAS
    // The first so many of the schema are there because the format can't leave them out (LAS: the fields of
    // the point format), whether or not somebody gave them a value.
    std::size_t imposedAttributes = 0;
    Crs crs; // not known() where the file states none
    // Bounds of the points in grid integers; empty where the file has no points or states none.
    BoxI bounds;
    // The bounds come from reading every point, or from the header's own statement, which may lie.
    bool boundsAreMeasured = false;
    GpsTimeKind gpsTime = GpsTimeKind::unknown;
    // The files that an input was made of, if it is a cloud itself; else empty.
    std::vector<SourceFile> madeOf;
    std::vector<std::string> warnings; // one sentence each, without the path
};

// One part of an input, which can be read without the others.
struct InputPart {
    std::uint64_t points = 0; // that it will hand out, at most
};

class PointStream {
  public:
    virtual ~PointStream() = default;
    // Replaces `batch` by the next points (at most pointsPerBatch, in the input's grid and schema); an empty
    // batch is the end. Errors name the file and the byte or line. Thread: one at a time.
    virtual Status next(PointBatch& batch) = 0;
    // Of everything handed out so far.
    virtual const ReadReport& report() const = 0;
};
inline constexpr std::size_t pointsPerBatch = 65536;

class PointInput {
  public:
    virtual ~PointInput() = default;
    virtual const InputDescription& description() const = 0;
    // What the file states of its bounds that the points' own box (grid integers) shows to be wrong, in one
    // sentence; nothing where they agree.
    virtual std::optional<std::string> contradiction(const BoxI&) const { return {}; }
    // In file order, each of some 50,000 to a million points where the file can be entered there, so
    // that threads share the work and a checkpoint loses little. The same at every opening.
    virtual const std::vector<InputPart>& parts() const = 0;
    // Thread: any, several at a time; streams of different parts are independent and must not outlive the
    // input. Memory of a stream: a few batches, whatever the file claims.
    virtual Result<std::unique_ptr<PointStream>> openPart(std::size_t part) const = 0;
};

} // namespace stipple
