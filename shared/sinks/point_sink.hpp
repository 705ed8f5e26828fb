// What takes the points of an export, in some file format.
#pragma once

#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/points/point_batch.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace stipple {

// What a sink's points look like: the cloud they are of, and which of its attributes, in this order.
struct SinkInput {
    const CloudMetadata& metadata; // outlives the sink
    std::vector<int> attributes;   // indices into metadata.schema.attributes

    const Attribute& attribute(std::size_t i) const {
        return metadata.schema.attributes[static_cast<std::size_t>(attributes[i])];
    }
    Schema schema() const {
        Schema schema;
        for (std::size_t i = 0; i < attributes.size(); ++i)
            schema.attributes.push_back(attribute(i));
        return schema;
    }
};

// Points in the form in which write() takes them: text, records, or as they were.
struct EncodedPoints {
    std::uint64_t count = 0;
    Bytes bytes;
    PointBatch batch;
};

class PointSink {
  public:
    virtual ~PointSink() = default; // without finish(): nothing of a file is left

    // The part of the work that needs no order: any number of threads at a time. batch.columns[i] belongs to
    // SinkInput::attributes[i].
    virtual Result<EncodedPoints> encode(PointBatch batch) const = 0;
    // One thread at a time, in the order of the file.
    virtual Status write(EncodedPoints points) = 0;
    virtual Status finish() = 0;
};

} // namespace stipple
