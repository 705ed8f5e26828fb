#include "client/render/software_points.hpp"

#include "client/render/software_coverage.hpp"
#include "client/render/software_discs.hpp"
#include "client/render/software_hiding.hpp"
#include "client/render/software_transform.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

namespace stipple {
namespace {

// The cell becomes the smaller of itself and `candidate`.
template <bool Shared>
STIPPLE_INLINE void offer(std::uint64_t& cell, std::uint64_t candidate) {
    if constexpr (Shared) {
        std::atomic_ref<std::uint64_t> shared(cell);
        std::uint64_t held = shared.load(std::memory_order_relaxed);
        while (candidate < held &&
               !shared.compare_exchange_weak(held, candidate, std::memory_order_relaxed)) {
        }
    } else {
        if (candidate < cell)
            cell = candidate;
    }
}

template <bool Shared, class Indices>
void placeSingle(const Block& block, std::size_t count, const Indices& index, std::uint64_t* cells) {
    for (std::size_t i = 0; i < count; ++i)
        offer<Shared>(cells[block.pixel[i]], (std::uint64_t{block.step[i]} << indexBits) | index(i));
}

// A square or circle of any size.
template <bool Shared>
void placeSprite(const RasterFrame& frame, int x, int y, int half, std::uint64_t candidate,
                 std::uint64_t* cells) {
    visitCovered(frame, x, y, half, [&](std::size_t cell, int) { offer<Shared>(cells[cell], candidate); });
}

// Points of exactly N pixels, N small: they cover N × N pixels, or those of them inside the circle. Without
// a branch on the shape, which would be mispredicted for every other point.
template <bool Shared, bool Circle, int N>
STIPPLE_INLINE void placeSmall(int x, int y, int column, int row, const RasterFrame& frame,
                               std::uint64_t candidate, std::uint64_t* cells) {
    constexpr int half = N * 128;
    auto width = static_cast<std::ptrdiff_t>(frame.width);
    const int below = frame.bottom + frame.height - 1 - row;
    std::uint64_t* line = cells + below * width + (column - frame.left);
    std::array<int, N> across;
    for (int c = 0; c < N; ++c) {
        int away = (column + c) * 256 + 128 - x;
        across[static_cast<std::size_t>(c)] = away * away;
    }
    for (int r = 0; r < N; ++r, line -= width) {
        int away = (row + r) * 256 + 128 - y;
        int left = half * half - away * away;
        for (int c = 0; c < N; ++c) {
            // Circles of two pixels and more hold the pixel of their point: its centre is at most 181 away.
            bool inside = !Circle || across[static_cast<std::size_t>(c)] <= left;
            offer<Shared>(line[c], inside ? candidate : emptyCell);
        }
    }
}
static_assert(2 * 128 > 181);

template <bool Shared, bool Circle, int N, class Indices>
void placeSmallBlock(const RasterFrame& frame, const Block& block, std::size_t count, const Indices& index,
                     std::uint64_t* cells) {
    constexpr int half = N * 128;
    for (std::size_t i = 0; i < count; ++i) {
        int x = 2 * block.x[i] + 1, y = 2 * block.y[i] + 1;
        int column = firstCovered(x, half), row = firstCovered(y, half);
        std::uint64_t candidate = (std::uint64_t{block.step[i]} << indexBits) | index(i);
        bool within = static_cast<unsigned>(column - frame.left) <= static_cast<unsigned>(frame.width - N) &&
                      static_cast<unsigned>(row - frame.bottom) <= static_cast<unsigned>(frame.height - N) &&
                      frame.width >= N && frame.height >= N;
        if (within)
            placeSmall<Shared, Circle, N>(x, y, column, row, frame, candidate, cells);
        else
            placeSprite<Shared>(frame, x, y, half, candidate, cells);
    }
}

template <bool Shared, class Indices>
void placeSprites(const RasterFrame& frame, const Block& block, std::size_t count, const Indices& index,
                  std::uint64_t* cells) {
    const bool sized = hasSizes(frame);
    for (std::size_t i = 0; i < count; ++i) {
        if (block.x[i] == nowhere)
            continue;
        int size64 = sized ? block.size64[i] : frame.size64;
        placeSprite<Shared>(frame, 2 * block.x[i] + 1, 2 * block.y[i] + 1, 2 * size64,
                            (std::uint64_t{block.step[i]} << indexBits) | index(i), cells);
    }
}

template <bool Shared, class Indices>
void placeParaboloids(const RasterFrame& frame, const Block& block, std::size_t count, const Indices& index,
                      std::uint64_t* cells) {
    const bool sized = hasSizes(frame);
    for (std::size_t i = 0; i < count; ++i) {
        if (block.x[i] == nowhere)
            continue;
        int size64 = sized ? block.size64[i] : frame.size64;
        const Bend bend = bendOf(frame, block.step[i], size64);
        visitCovered(frame, 2 * block.x[i] + 1, 2 * block.y[i] + 1, 2 * size64,
                     [&](std::size_t cell, int away) {
                         offer<Shared>(cells[cell],
                                       (std::uint64_t{bentStep(frame, bend, away)} << indexBits) | index(i));
                     });
    }
}

template <bool Shared, class Indices>
void placeDiscs(const RasterFrame& frame, const Block& block, std::size_t count, const Indices& index,
                const std::uint32_t* normals, std::uint64_t* cells) {
    const bool sized = hasSizes(frame);
    for (std::size_t i = 0; i < count; ++i) {
        if (block.x[i] == nowhere)
            continue;
        const int x = 2 * block.x[i] + 1, y = 2 * block.y[i] + 1;
        const int size64 = sized ? block.size64[i] : frame.size64;
        const Disc disc = discOf(frame, x, y, size64, block.step[i], normals[i]);
        visitDisc(frame, disc, x, y, [&](std::size_t cell, const DiscSpot& spot) {
            offer<Shared>(cells[cell], (std::uint64_t{stepOf(frame, spot.distance)} << indexBits) | index(i));
        });
    }
}

template <bool Shared, class Indices>
void placeFixed(const RasterFrame& frame, const Block& block, std::size_t count, const Indices& index,
                std::uint64_t* cells) {
    switch (frame.size64) {
    case 2 * sizeSteps:
        return frame.circle ? placeSmallBlock<Shared, true, 2>(frame, block, count, index, cells)
                            : placeSmallBlock<Shared, false, 2>(frame, block, count, index, cells);
    case 3 * sizeSteps:
        return frame.circle ? placeSmallBlock<Shared, true, 3>(frame, block, count, index, cells)
                            : placeSmallBlock<Shared, false, 3>(frame, block, count, index, cells);
    case 4 * sizeSteps:
        return frame.circle ? placeSmallBlock<Shared, true, 4>(frame, block, count, index, cells)
                            : placeSmallBlock<Shared, false, 4>(frame, block, count, index, cells);
    default:
        return placeSprites<Shared>(frame, block, count, index, cells);
    }
}

template <bool Shared, class Indices>
void placeBlock(const RasterFrame& frame, const Block& block, std::size_t count, Sizing sizing,
                const Indices& index, const std::uint32_t* normals, std::uint64_t* cells) {
    if (sizing == Sizing::single)
        placeSingle<Shared>(block, count, index, cells);
    else if (frame.disc && normals)
        placeDiscs<Shared>(frame, block, count, index, normals, cells);
    else if (frame.paraboloid)
        placeParaboloids<Shared>(frame, block, count, index, cells);
    else if (hasSizes(frame))
        placeSprites<Shared>(frame, block, count, index, cells);
    else
        placeFixed<Shared>(frame, block, count, index, cells);
}

template <bool Shared>
void drawRunImpl(const RasterFrame& frame, const PointRun& run, std::uint64_t* cells) {
    Block block;
    const Sizing sizing = sizingOf(frame);
    for (std::uint32_t done = 0; done < run.count; done += blockPoints) {
        std::size_t count = std::min<std::size_t>(blockPoints, run.count - done);
        fillBlock(frame, run, done, count, sizing, block);
        const std::uint64_t first = run.index + done;
        placeBlock<Shared>(
            frame, block, count, sizing, [first](std::size_t i) { return first + i; },
            run.normals ? run.normals + run.first + done : nullptr, cells);
    }
}

} // namespace

void fillBlock(const RasterFrame& frame, const PointRun& run, std::size_t done, std::size_t count,
               Sizing sizing, Block& block) {
    Words words = wordsFrom(*run.node, run.first + done);
    if (sizing == Sizing::adaptive || sizing == Sizing::growing)
        fillFineness(run.octree, run.place, *run.node, words, count, block);
    transformFor(frame, *run.raster, sizing)(frame, *run.raster, words, count, block);
    if (run.hiding)
        hidePoints(run.hiding + run.first + done, count,
                   static_cast<std::uint32_t>(frame.width) * static_cast<std::uint32_t>(frame.height), sizing,
                   block);
}

void drawRun(const RasterFrame& frame, const PointRun& run, std::uint64_t* cells, bool shared) {
    if (shared)
        drawRunImpl<true>(frame, run, cells);
    else
        drawRunImpl<false>(frame, run, cells);
}

void placeListed(const RasterFrame& frame, const Block& block, std::size_t count, Sizing sizing,
                 const std::uint32_t* indices, const std::uint32_t* normals, std::uint64_t* cells,
                 bool shared) {
    auto index = [indices](std::size_t i) { return std::uint64_t{indices[i]}; };
    if (shared)
        placeBlock<true>(frame, block, count, sizing, index, normals, cells);
    else
        placeBlock<false>(frame, block, count, sizing, index, normals, cells);
}

} // namespace stipple
