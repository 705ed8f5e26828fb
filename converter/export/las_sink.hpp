// Points as a LAS or LAZ file, with their exact integers.
//
// The point format is that of the sources, where they had one in common and all attributes are kept; else the
// smallest whose fields hold most of the attributes with all their values. Attributes without a field go to
// described extra bytes, also those that have the name of a LAS field but another type (under a name that
// says so). The CRS goes in as WKT, which makes it LAS 1.4. Where integers exceed 32 bits they are counted
// from another offset.
#pragma once

#include "converter/export/point_sink.hpp"
#include "shared/las/las_header.hpp"
#include "shared/las/las_writer.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stipple {

class LasSink final : public PointSink {
  public:
    // `reach`: a box in which all points lie (grid integers). `expectedPoints`: at most so many; 0: unknown.
    // outOfRange if the reach is wider than 2^32 steps.
    static Result<std::unique_ptr<LasSink>> create(const std::string& path, const SinkInput& input,
                                                   const BoxI& reach, std::uint64_t expectedPoints,
                                                   bool compressed);

    Result<EncodedPoints> encode(PointBatch batch) const override;
    Status write(EncodedPoints points) override;
    Status finish() override;

    const las::Header& header() const { return writer_->header(); }
    // What could not be written as it is, one sentence each.
    const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    Vec3i shift_;
    std::unique_ptr<las::Writer> writer_;
    std::vector<std::string> warnings_;
};

} // namespace stipple
