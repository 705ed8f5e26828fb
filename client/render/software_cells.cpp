#include "client/render/software_cells.hpp"

#include "client/render/software_points.hpp"

#include <algorithm>

namespace stipple {

void CellParts::resize(int width, int height, int threads) {
    std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::size_t affordable = partsBytes / sizeof(std::uint64_t) / (pixels + 1);
    std::size_t count =
        std::max<std::size_t>(1, std::min({static_cast<std::size_t>(threads), maxParts, affordable}));
    width_ = static_cast<std::size_t>(width);
    if (pixels == pixels_ && count == parts_.size())
        return;
    pixels_ = pixels;
    parts_.resize(count);
    for (std::vector<std::uint64_t>& part : parts_) {
        part.assign(pixels + 1, emptyCell);
        part.back() = 0;
    }
}

void CellParts::clearRow(int y) {
    std::fill_n(cells() + static_cast<std::size_t>(y) * width_, width_, emptyCell);
}

void CellParts::gatherRow(int y) {
    std::size_t first = static_cast<std::size_t>(y) * width_;
    std::uint64_t* into = cells() + first;
    for (std::size_t i = 1; i < parts_.size(); ++i) {
        std::uint64_t* from = part(i) + first;
        for (std::size_t x = 0; x < width_; ++x) {
            into[x] = std::min(into[x], from[x]);
            from[x] = emptyCell;
        }
    }
}

} // namespace stipple
