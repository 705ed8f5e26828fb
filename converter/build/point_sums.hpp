// An input's points as the cloud's, and what is summed over all of them on the way.
#pragma once

#include "converter/build/scan.hpp"
#include "shared/base/bytes.hpp"
#include "shared/format/point_hash.hpp"
#include "shared/geometry/box.hpp"

#include <array>

namespace stipple {

// What decides which colour travels with the positions.
struct ColourExtremes {
    std::array<std::uint16_t, 3> rgbMax{}; // 0 where the attribute is absent or no uint16
    std::uint16_t intensityMin = 0xFFFF, intensityMax = 0;

    void extend(const ColourExtremes& other);
};

struct PointSums {
    std::uint64_t points = 0;
    BoxI bounds;                   // grid integers of the cloud
    std::vector<BoxI> inputBounds; // in each input's own integers
    PointHash hash;
    std::vector<PointHash> inputHashes; // of each input's points as it hands them out
    ColourExtremes colour;
    double maxGridError = 0;         // world units; > 0 only where inputs do not fit one grid exactly
    std::vector<ReadReport> reports; // of each input: dropped points by reason

    explicit PointSums(std::size_t inputs = 0) : inputBounds(inputs), inputHashes(inputs), reports(inputs) {}
    ReadReport report() const;        // of all inputs together
    void add(const PointSums& other); // of the same inputs
    // For checkpoints. load() answers false if the bytes are no sums of so many inputs.
    void save(ByteWriter& to) const;
    bool load(ByteReader& from);

    // What they show of the inputs: headers that lie, points that were moved or dropped; a sentence each.
    std::vector<std::string> warnings(const Scan& scan) const;
};

// How many points were dropped and why: a sentence for each reason.
std::vector<std::string> droppedTexts(const ReadReport& report);

// The points of one batch of input `input` on the cloud's grid and in its schema: `raw` itself where nothing
// changes, else `mapped`, which is overwritten. Adds them to `sums` (not to its hashes, nor its report).
const PointBatch& toCloud(const Scan& scan, std::size_t input, const PointBatch& raw, PointBatch& mapped,
                          PointSums& sums);

} // namespace stipple
