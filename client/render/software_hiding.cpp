#include "client/render/software_hiding.hpp"

namespace stipple {

void hidePoints(const std::uint32_t* words, std::size_t count, std::uint32_t outside, Sizing sizing,
                Block& block) {
    if (sizing == Sizing::single) {
        for (std::size_t i = 0; i < count; ++i)
            block.pixel[i] = (words[i] >> 24) != 0 ? block.pixel[i] : outside;
    } else {
        for (std::size_t i = 0; i < count; ++i)
            block.x[i] = (words[i] >> 24) != 0 ? block.x[i] : nowhere;
    }
}

} // namespace stipple
