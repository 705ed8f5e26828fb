#include "client/render/software_expansion.hpp"

#include "client/render/software_transform.hpp"

#include <algorithm>
#include <array>

namespace stipple {
namespace {

std::size_t pixelFromBottom(const RasterFrame& frame, std::size_t cell) {
    auto width = static_cast<std::size_t>(frame.width), height = static_cast<std::size_t>(frame.height);
    return (height - 1 - cell / width) * width + cell % width;
}

// Covered pixels of some rows, sorted by the node of their point.
struct Covered {
    std::vector<std::uint32_t> pixels; // cells
    std::vector<std::size_t> firsts;   // per node: of its pixels; one more at the end
};

std::size_t nodeOf(const std::vector<PlacedNode>& nodes, std::uint64_t index) {
    auto next = std::upper_bound(nodes.begin(), nodes.end(), index,
                                 [](std::uint64_t i, const PlacedNode& node) { return i < node.firstIndex; });
    return static_cast<std::size_t>(next - nodes.begin()) - 1;
}

Covered coveredPixels(const RasterFrame& frame, const Centres& centres, RowRange rows) {
    const std::vector<PlacedNode>& nodes = *centres.nodes;
    auto width = static_cast<std::size_t>(frame.width);
    std::size_t begin = static_cast<std::size_t>(rows.first) * width,
                end = static_cast<std::size_t>(rows.end) * width;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found; // node, pixel
    Covered covered;
    covered.firsts.resize(nodes.size() + 1);
    std::size_t last = 0; // neighbours are often of one node
    for (std::size_t cell = begin; cell < end; ++cell) {
        if (centres.cells[cell] == emptyCell)
            continue;
        std::uint64_t index = centres.cells[cell] & indexMask;
        if (index - nodes[last].firstIndex >= nodes[last].draw->pointCount)
            last = nodeOf(nodes, index);
        found.emplace_back(static_cast<std::uint32_t>(last), static_cast<std::uint32_t>(cell));
        ++covered.firsts[last + 1];
    }
    for (std::size_t i = 0; i < nodes.size(); ++i)
        covered.firsts[i + 1] += covered.firsts[i];
    covered.pixels.resize(found.size());
    std::vector<std::size_t> places(covered.firsts.begin(), covered.firsts.end() - 1);
    for (const auto& [node, pixel] : found)
        covered.pixels[places[node]++] = pixel;
    return covered;
}

// The words of some points of a node, side by side.
struct Gathered {
    std::array<std::uint32_t, 2 * blockPoints> positions;
    std::array<std::uint32_t, blockPoints> lows, ranks, normals; // the last of use to discs alone

    void take(const PlacedNode& placed, const std::uint64_t* cells, const std::uint32_t* pixels,
              std::size_t count) {
        const ResidentNode& node = *placed.draw->node;
        const NodeNormals* oriented = placed.draw->normals.get();
        for (std::size_t i = 0; i < count; ++i) {
            std::size_t point = (cells[pixels[i]] & indexMask) - placed.firstIndex;
            ranks[i] = static_cast<std::uint32_t>(point);
            positions[2 * i] = node.positionWords[2 * point];
            positions[2 * i + 1] = node.positionWords[2 * point + 1];
            lows[i] = node.positionShift > 0 ? node.positionLowWords[point] : 0;
            normals[i] = oriented ? oriented->words[point] : noNormalWord;
        }
    }
    Words words(const PlacedNode& placed) const {
        return {positions.data(), placed.raster.positionShift > 0 ? lows.data() : nullptr, 0, ranks.data()};
    }
};

// visit(node, block, count, pixels, the points' words) for all points whose centres are in the rows.
template <class Visit>
void visitCentres(const RasterFrame& frame, const Centres& centres, RowRange rows, Sizing sizing,
                  const Visit& visit) {
    Covered covered = coveredPixels(frame, centres, rows);
    Block block;
    Gathered gathered;
    for (std::size_t n = 0; n < centres.nodes->size(); ++n) {
        const PlacedNode& placed = (*centres.nodes)[n];
        for (std::size_t at = covered.firsts[n]; at < covered.firsts[n + 1]; at += blockPoints) {
            std::size_t count = std::min(blockPoints, covered.firsts[n + 1] - at);
            const std::uint32_t* pixels = covered.pixels.data() + at;
            gathered.take(placed, centres.cells, pixels, count);
            Words words = gathered.words(placed);
            if (walksOctree(frame))
                fillFineness(centres.octree, placed.octreePlace, *placed.draw->node, words, count, block);
            transformFor(frame, placed.raster, sizing)(frame, placed.raster, words, count, block);
            visit(placed, block, count, pixels, gathered);
        }
    }
}

} // namespace

void expandRows(const RasterFrame& frame, const Centres& centres, RowRange rows, std::uint64_t* cells,
                bool shared) {
    std::array<std::uint32_t, blockPoints> indices;
    Sizing sizing = sizingOf(frame);
    visitCentres(frame, centres, rows, sizing,
                 [&](const PlacedNode&, const Block& block, std::size_t count, const std::uint32_t* pixels,
                     const Gathered& gathered) {
                     for (std::size_t i = 0; i < count; ++i)
                         indices[i] = static_cast<std::uint32_t>(pixelFromBottom(frame, pixels[i]));
                     placeListed(frame, block, count, sizing, indices.data(), gathered.normals.data(), cells,
                                 shared);
                 });
}

void blendExpandedRows(const RasterFrame& frame, const Centres& centres, RowRange rows,
                       const std::uint64_t* nearest, PixelSums* sums) {
    std::array<std::uint32_t, blockPoints> colours;
    Sizing sizing = sizingOf(frame) == Sizing::single ? Sizing::fixed : sizingOf(frame);
    visitCentres(frame, centres, rows, sizing,
                 [&](const PlacedNode& placed, const Block& block, std::size_t count, const std::uint32_t*,
                     const Gathered& gathered) {
                     for (std::size_t i = 0; i < count; ++i)
                         colours[i] = colourOf(*placed.draw, gathered.ranks[i]);
                     blendBlock(frame, block, count, colours.data(), gathered.normals.data(), nearest, sums);
                 });
}

void nameExpandedRow(const RasterFrame& frame, const Centres& centres, int y, std::uint64_t* cells) {
    auto width = static_cast<std::size_t>(frame.width);
    for (std::size_t cell = static_cast<std::size_t>(y) * width, end = cell + width; cell < end; ++cell)
        if (cells[cell] != emptyCell) {
            // Counting from the bottom is its own inverse.
            std::uint64_t centre = centres.cells[pixelFromBottom(frame, cells[cell] & indexMask)];
            cells[cell] = (cells[cell] & ~indexMask) | (centre & indexMask);
        }
}

} // namespace stipple
