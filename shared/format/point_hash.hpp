// An order-independent 128-bit hash over points: the sum modulo 2^128 of a hash of each point's grid
// integers and raw attribute bytes (in schema order). Equal multisets have equal sums; a lost, doubled or
// altered point changes it (up to chance 2^-128 for accidents; it is no defence against an adversary).
#pragma once

#include "shared/points/point_batch.hpp"

#include <cstdint>
#include <string>

namespace stipple {

struct PointHash {
    std::uint64_t low = 0, high = 0;

    void add(const Schema& schema, const PointBatch& batch); // every point of the batch
    void add(const PointHash& other);
    std::string hex() const; // 32 digits, high first
    friend bool operator==(const PointHash&, const PointHash&) = default;
};

} // namespace stipple
