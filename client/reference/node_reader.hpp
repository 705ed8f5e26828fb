// Every node of a cloud once, read on the calling thread and decoded on others.
#pragma once

#include "shared/format/cloud_file.hpp"

#include <functional>
#include <span>

namespace stipple::reference {

// `visit` gets each node's points with the columns of `attributes` (indices into the schema) and the number
// of points of all nodes before it; it runs on any of `threads` threads, several at a time. Returns the first
// error.
Status visitPoints(
    CloudReader& reader, std::span<const int> attributes, int threads,
    const std::function<void(const NodeKey& key, const PointBatch& points, std::uint64_t firstOrder)>& visit);

} // namespace stipple::reference
