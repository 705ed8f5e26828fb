#include "shared/select/point_chooser.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace stipple {

namespace {

// `to` has room for them.
void gather(const Bytes& from, std::span<const std::uint32_t> rows, std::size_t size, std::uint8_t* to) {
    auto gatherAs = [&](auto width) {
        for (std::size_t i = 0; i < rows.size(); ++i)
            std::memcpy(to + i * width, from.data() + rows[i] * width, width);
    };
    switch (size) { // a constant width lets the compiler turn the copy into one move
    case 1:
        return gatherAs(std::integral_constant<std::size_t, 1>{});
    case 2:
        return gatherAs(std::integral_constant<std::size_t, 2>{});
    case 4:
        return gatherAs(std::integral_constant<std::size_t, 4>{});
    case 8:
        return gatherAs(std::integral_constant<std::size_t, 8>{});
    default:
        return gatherAs(size);
    }
}

} // namespace

Result<PointChooser> PointChooser::make(const CloudMetadata& metadata, const CloudFilter& filter,
                                        std::vector<int> attributes) {
    PointChooser made(metadata, filter);
    const auto stored = static_cast<int>(metadata.schema.attributes.size());
    for (int attribute : attributes)
        (attribute < stored ? made.stored_ : made.derived_).push_back(attribute);
    // Those behind the cloud's own are station and offset, and stand last.
    bool areLast = std::equal(made.derived_.rbegin(), made.derived_.rend(), attributes.rbegin());
    bool areKnown =
        std::all_of(made.derived_.begin(), made.derived_.end(), [&](int a) { return a < stored + 2; }) &&
        std::all_of(attributes.begin(), attributes.end(), [](int a) { return a >= 0; });
    if (!areKnown || (!made.derived_.empty() && (!areLast || !filter.hasCorridor())))
        return Error{ErrorCode::invalidArgument, say("there are no such attributes"), "", ""};
    made.read_ = made.stored_;
    for (int attribute : filter.testedAttributes()) {
        auto place = std::find(made.read_.begin(), made.read_.end(), attribute);
        made.testedPlaces_.push_back(static_cast<std::size_t>(place - made.read_.begin()));
        if (place == made.read_.end())
            made.read_.push_back(attribute);
    }
    for (int attribute : made.stored_)
        made.sizes_.push_back(metadata.schema.attributes[static_cast<std::size_t>(attribute)].size());
    return made;
}

Result<PointBatch> PointChooser::choose(const NodeBytes& node, bool tested, CloudFilter::Dropped& dropped,
                                        const WorkGate* gate) const {
    STIPPLE_TRY(batch, decodeNode(*metadata_, node, gate));
    if (batch.size() != node.entry.pointCount)
        return Error{ErrorCode::corrupt,
                     say("node ", node.entry.key.text(), " has ", batch.size(), " points instead of ",
                         node.entry.pointCount),
                     "", ""};
    if (tested) {
        STIPPLE_TRY(kept, test(node.entry, std::move(batch), dropped, gate));
        batch = std::move(kept);
    }
    if (derived_.empty())
        return batch;
    STIPPLE_TRY(places, filter_->placesAlong(node.entry, batch.positions, gate));
    for (int attribute : derived_)
        batch.columns.push_back(
            places[static_cast<std::size_t>(attribute) - metadata_->schema.attributes.size()]);
    return batch;
}

Result<PointBatch> PointChooser::test(const NodeEntry& entry, PointBatch batch, CloudFilter::Dropped& dropped,
                                      const WorkGate* gate) const {
    std::vector<const Bytes*> columns;
    for (std::size_t place : testedPlaces_)
        columns.push_back(&batch.columns[place]);
    STIPPLE_TRY(rows, filter_->select(entry, batch.positions, columns, dropped, gate));
    if (rows.size() != batch.size())
        return pick(batch, rows, gate);
    batch.columns.resize(stored_.size());
    return batch;
}

Result<PointBatch> PointChooser::pick(const PointBatch& batch, std::span<const std::uint32_t> rows,
                                      const WorkGate* gate) const {
    PointBatch picked;
    picked.positions.reserve(rows.size());
    for (std::size_t size : sizes_)
        picked.columns.emplace_back(rows.size() * size);
    STIPPLE_CHECK(inPieces(gate, rows.size(), [&](std::size_t first, std::size_t end) {
        auto piece = rows.subspan(first, end - first);
        for (std::uint32_t row : piece)
            picked.positions.push_back(batch.positions[row]);
        for (std::size_t i = 0; i < sizes_.size(); ++i)
            gather(batch.columns[i], piece, sizes_[i], picked.columns[i].data() + first * sizes_[i]);
    }));
    return picked;
}

} // namespace stipple
