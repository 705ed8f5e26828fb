// Points as a LAS or LAZ file, with their exact integers.
//
// The point format is that of the sources, where they had one in common and all attributes are kept; else the
// smallest whose fields hold most of the attributes with all their values. Attributes without a field go to
// described extra bytes, also those that have the name of a LAS field but another type (under a name that
// says so). The CRS goes in as WKT, which makes it LAS 1.4. Where integers exceed 32 bits they are counted
// from another offset.
#pragma once

#include "shared/io/byte_sink.hpp"
#include "shared/las/las_header.hpp"
#include "shared/las/las_writer.hpp"
#include "shared/sinks/point_sink.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stipple {

// The WKT of an EPSG code, for clouds that have no WKT of their own.
using WktOfCode = std::function<Result<std::string>(int epsg)>;

// How points become records: decided before any of them is read.
struct LasPlan {
    las::WriterOptions options;
    Vec3i shift; // to be subtracted from the cloud's integers
    // What could not be written as it is, one sentence each.
    std::vector<std::string> warnings;

    // `reach`: a box in which all points lie (grid integers). `expectedPoints`: at most so many; 0: unknown.
    // Without `wktOfCode`, a cloud that names its system by a code alone loses it, with a warning.
    // outOfRange if the reach is wider than 2^32 steps.
    static Result<LasPlan> make(const SinkInput& input, const BoxI& reach, std::uint64_t expectedPoints,
                                bool compressed, const WktOfCode& wktOfCode = nullptr);
};

class LasSink final : public PointSink {
  public:
    // `summary`: of all points that will come, in the plan's integers (summarizeForLas); needed where `to`
    // can't be overwritten, which LAZ can't be written to.
    static Result<std::unique_ptr<LasSink>> create(std::unique_ptr<ByteSink> to, const LasPlan& plan,
                                                   std::optional<las::PointSummary> summary);

    Result<EncodedPoints> encode(PointBatch batch) const override;
    Status write(EncodedPoints points) override;
    Status finish() override;

    const las::Header& header() const { return writer_->header(); }
    // Those of the plan and of the writer.
    const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    Vec3i shift_;
    std::unique_ptr<las::Writer> writer_;
    std::vector<std::string> warnings_;
};

} // namespace stipple
