// Where the software renderer's points lie in the picture: block by block, with vector instructions.
#pragma once

#include "client/render/raster_setup.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace stipple {

inline constexpr std::size_t blockPoints = 512;

// Window positions of a block: 1/128-pixel cells (raster_setup.hpp), depth steps, sizes in 1/64 pixel.
// Points that are not drawn lie at `nowhere`.
inline constexpr std::int32_t nowhere = -static_cast<std::int32_t>(positionLimit) * positionCells;
struct Block {
    alignas(64) std::array<std::int32_t, blockPoints> x, y, size64;
    alignas(64) std::array<std::uint32_t, blockPoints> step;
    alignas(64) std::array<std::uint32_t, blockPoints> pixel; // single pixels only
    // Sizes from the octree, to be filled before the transform: 2^-k (raster_setup.hpp, "Adaptive"); 2^g
    // ("Growing").
    alignas(64) std::array<float, blockPoints> fineness, doubling;
};

enum class Sizing { single, fixed, byDistance, adaptive, growing };
Sizing sizingOf(const RasterFrame& frame);
// Whether a block's size64 says how large its points are; else all are of RasterFrame::size64.
inline bool hasSizes(const RasterFrame& frame) {
    return sizesDiffer(frame) || frame.continuous;
}

struct Words {
    const std::uint32_t* position;
    const std::uint32_t* low;             // nullptr: no low words
    std::uint32_t rank;                   // of the first point in its node
    const std::uint32_t* ranks = nullptr; // of each point in its node; nullptr: one after another from `rank`
};

inline Words wordsFrom(const ResidentNode& node, std::size_t first) {
    return {node.positionWords.data() + 2 * first,
            node.positionShift > 0 ? node.positionLowWords.data() + first : nullptr,
            static_cast<std::uint32_t>(first)};
}

using Transform = void (*)(const RasterFrame&, const RasterNode&, Words, std::size_t count, Block&);

// `octree`: words of drawn_octree.hpp; `place`: the node's.
void fillFineness(const std::uint32_t* octree, std::uint32_t place, const ResidentNode& node, Words words,
                  std::size_t count, Block& block);

// Fills the first `count` <= blockPoints entries of a block; for the processor that runs it.
Transform transformFor(const RasterFrame& frame, const RasterNode& node, Sizing sizing);

} // namespace stipple
