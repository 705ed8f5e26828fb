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
};

enum class Sizing { single, fixed, byDistance };

struct Words {
    const std::uint32_t* position;
    const std::uint32_t* low; // nullptr: no low words
    std::uint32_t rank;       // of the first point in its node
};

using Transform = void (*)(const RasterFrame&, const RasterNode&, Words, std::size_t count, Block&);

// Fills the first `count` <= blockPoints entries of a block; for the processor that runs it.
Transform transformFor(const RasterFrame& frame, const RasterNode& node, Sizing sizing);

} // namespace stipple
