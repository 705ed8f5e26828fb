// Takes the hidden points of a node (NodePaint) out of a block that is about to be drawn.
#pragma once

#include "client/render/software_transform.hpp"

namespace stipple {

// `words`: of the block's points; those without alpha are hidden. `outside`: the pixel behind the picture's
// last, where single pixels go that are not drawn.
void hidePoints(const std::uint32_t* words, std::size_t count, std::uint32_t outside, Sizing sizing,
                Block& block);

} // namespace stipple
