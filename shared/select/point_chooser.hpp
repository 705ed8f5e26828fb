// From the bytes of a node to those of its points that a filter wants, with the attributes that are asked
// for. Pure: any thread.
#pragma once

#include "shared/base/result.hpp"
#include "shared/base/work_gate.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/select/cloud_filter.hpp"

#include <span>
#include <vector>

namespace stipple {

class PointChooser {
  public:
    // `attributes`: indices into the schema; behind the cloud's own, and last, station and offset where the
    // filter has a corridor (corridor_attributes.hpp). All three outlive this, or the program. Errors:
    // invalidArgument for attributes that there are none of.
    static Result<PointChooser> make(const CloudMetadata& metadata, const CloudFilter& filter,
                                     std::vector<int> attributes);

    // What has to be read of a node (NodeBytes::attributes), if its points are tested or all wanted.
    const std::vector<int>& attributesToRead(bool tested) const { return tested ? read_ : stored_; }

    // The points wanted, in progressive order; batch.columns[i] is attribute i of those asked for. Errors:
    // those of decodeNode(), corrupt for a node that holds another number of points than its entry says;
    // `cancelled` once the gate is closed.
    Result<PointBatch> choose(const NodeBytes& node, bool tested, CloudFilter::Dropped& dropped,
                              const WorkGate* gate = nullptr) const;

  private:
    PointChooser(const CloudMetadata& metadata, const CloudFilter& filter)
        : metadata_(&metadata), filter_(&filter) {}
    Result<PointBatch> test(const NodeEntry& entry, PointBatch batch, CloudFilter::Dropped& dropped,
                            const WorkGate* gate) const;
    Result<PointBatch> pick(const PointBatch& batch, std::span<const std::uint32_t> rows,
                            const WorkGate* gate) const;

    const CloudMetadata* metadata_;
    const CloudFilter* filter_;
    std::vector<int> stored_, derived_;     // of those asked for: the cloud's own, and those computed
    std::vector<int> read_;                 // those of the cloud, then those only tests need
    std::vector<std::size_t> testedPlaces_; // of the filter's attributes among them
    std::vector<std::size_t> sizes_;        // bytes of the stored ones
};

} // namespace stipple
