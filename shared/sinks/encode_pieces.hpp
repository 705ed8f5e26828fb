// A sink's encoding in pieces, between which it can be broken off.
#pragma once

#include "shared/base/work_gate.hpp"
#include "shared/sinks/point_sink.hpp"

#include <utility>

namespace stipple {

// Encodes the first `size` points of the batch and calls take(EncodedPoints) with them, in their order and
// WorkGate::pieceItems at a time (once for no points); `take` returns a Status. Errors: those of the sink and
// of `take`; cancelled once the gate is closed. Thread: as PointSink::encode(), but for what `take` does.
template <class Take>
Status encodeInPieces(const PointSink& sink, PointBatch batch, std::size_t size, const WorkGate* gate,
                      const Take& take) {
    if (size == batch.size() && size <= WorkGate::pieceItems) {
        STIPPLE_CHECK(askGate(gate, size));
        STIPPLE_TRY(encoded, sink.encode(std::move(batch)));
        return take(std::move(encoded));
    }
    return inPieces(gate, size, [&](std::size_t first, std::size_t end) -> Status {
        PointBatch part;
        part.positions.assign(batch.positions.begin() + static_cast<std::ptrdiff_t>(first),
                              batch.positions.begin() + static_cast<std::ptrdiff_t>(end));
        for (const Bytes& column : batch.columns) {
            std::size_t width = column.size() / batch.size();
            part.columns.emplace_back(column.data() + first * width, column.data() + end * width);
        }
        STIPPLE_TRY(encoded, sink.encode(std::move(part)));
        return take(std::move(encoded));
    });
}

} // namespace stipple
