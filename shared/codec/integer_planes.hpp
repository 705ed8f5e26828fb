// Integers as byte planes: all lowest bytes, then all second bytes, … each a section of its own, so that
// noisy low bytes do not hide the order in the high ones (docs/FORMAT.md, "Planes").
//
//   u8       0: the values; 1: zigzag differences, each to the value before (the first to 0)
//   section  of the lowest bytes, then of each higher byte
#pragma once

#include "shared/base/work_gate.hpp"
#include "shared/codec/section.hpp"

namespace stipple {

// Writes `values`, unsigned integers of the width of T, in whichever way is smaller.
template <class T>
void writePlanes(ByteWriter& to, std::span<const T> values);

// Fills `values`. Errors: truncated, corrupt; cancelled once the gate is closed.
template <class T>
Status readPlanes(ByteReader& from, std::span<T> values, const WorkGate* gate = nullptr);

} // namespace stipple
