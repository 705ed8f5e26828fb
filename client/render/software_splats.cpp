#include "client/render/software_splats.hpp"

#include "client/render/software_coverage.hpp"
#include "client/render/software_discs.hpp"
#include "client/render/software_transform.hpp"

#include <cstring>

namespace stipple {
namespace {

// 1..2^16 for a pixel whose centre is `away` from the point: square of the distance over that of the radius.
STIPPLE_INLINE std::uint32_t weightAt(float away, int hardness) {
    float base = std::max(1.0f - away, 0.0f), weight = base;
    for (int i = 1; i < hardness; ++i)
        weight *= base;
    return static_cast<std::uint32_t>(weight * 65535.0f) + 1;
}

STIPPLE_INLINE void add(PixelSums& sums, std::uint32_t colour, std::uint64_t weight) {
    sums.red += weight * (colour & 255u);
    sums.green += weight * (colour >> 8 & 255u);
    sums.blue += weight * (colour >> 16 & 255u);
    sums.weight += weight;
}

} // namespace

namespace {

void blendDiscs(const RasterFrame& frame, const Block& block, std::size_t count, const std::uint32_t* colours,
                const std::uint32_t* normals, const std::uint64_t* cells, PixelSums* sums) {
    const bool sized = hasSizes(frame);
    for (std::size_t i = 0; i < count; ++i) {
        if (block.x[i] == nowhere)
            continue;
        const int x = 2 * block.x[i] + 1, y = 2 * block.y[i] + 1;
        const int size64 = sized ? block.size64[i] : frame.size64;
        const Disc disc = discOf(frame, x, y, size64, block.step[i], normals[i]);
        const float depth = blendDepth(frame, disc.distance, size64);
        visitDisc(frame, disc, x, y, [&](std::size_t cell, const DiscSpot& spot) {
            std::uint64_t back = std::uint64_t{blendedStep(frame, spot.distance, depth)} << indexBits;
            if (back <= (cells[cell] | indexMask))
                add(sums[cell], colours[i], weightAt(spot.inside ? spot.away : 1.0f, frame.hardness));
        });
    }
}

} // namespace

void blendBlock(const RasterFrame& frame, const Block& block, std::size_t count, const std::uint32_t* colours,
                const std::uint32_t* normals, const std::uint64_t* cells, PixelSums* sums) {
    if (frame.disc && normals)
        return blendDiscs(frame, block, count, colours, normals, cells, sums);
    const bool sized = hasSizes(frame);
    for (std::size_t i = 0; i < count; ++i) {
        if (block.x[i] == nowhere)
            continue;
        int size64 = sized ? block.size64[i] : frame.size64, half = 2 * size64;
        const float distance = distanceOfStep(frame, block.step[i]);
        std::uint64_t back = std::uint64_t{blendedStep(frame, distance, blendDepth(frame, distance, size64))}
                             << indexBits;
        float inverseSquare = 1.0f / (static_cast<float>(half) * static_cast<float>(half));
        visitCovered(frame, 2 * block.x[i] + 1, 2 * block.y[i] + 1, half, [&](std::size_t cell, int away) {
            if (back <= (cells[cell] | indexMask))
                add(sums[cell], colours[i],
                    weightAt(static_cast<float>(away) * inverseSquare, frame.hardness));
        });
    }
}

void blendRun(const RasterFrame& frame, const PlacedNode& placed, const PointRun& run,
              const std::uint64_t* cells, PixelSums* sums) {
    Block block;
    std::array<std::uint32_t, blockPoints> colours;
    Sizing sizing = sizingOf(frame) == Sizing::single ? Sizing::fixed : sizingOf(frame);
    for (std::uint32_t done = 0; done < run.count; done += blockPoints) {
        std::size_t count = std::min<std::size_t>(blockPoints, run.count - done);
        fillBlock(frame, run, done, count, sizing, block);
        for (std::size_t i = 0; i < count; ++i)
            colours[i] = colourOf(*placed.draw, run.first + done + i);
        blendBlock(frame, block, count, colours.data(),
                   run.normals ? run.normals + run.first + done : nullptr, cells, sums);
    }
}

void blendedRow(const FramePlan& plan, const RasterFrame& frame, std::span<const PixelSums* const> sums,
                const std::uint64_t* cells, int y, Image& image, InverseDistances* distances) {
    auto width = static_cast<std::size_t>(frame.width), line = static_cast<std::size_t>(y) * width;
    for (std::size_t x = 0; x < width; ++x) {
        PixelSums all;
        for (const PixelSums* part : sums) {
            all.red += part[line + x].red;
            all.green += part[line + x].green;
            all.blue += part[line + x].blue;
            all.weight += part[line + x].weight;
        }
        std::array<std::uint8_t, 4> pixel{plan.style.background[0], plan.style.background[1],
                                          plan.style.background[2], 255};
        if (std::uint64_t weight = all.weight; weight > 0)
            pixel = {static_cast<std::uint8_t>((all.red + weight / 2) / weight),
                     static_cast<std::uint8_t>((all.green + weight / 2) / weight),
                     static_cast<std::uint8_t>((all.blue + weight / 2) / weight), 255};
        std::memcpy(image.rgba.data() + 4 * (line + x), pixel.data(), 4);
        if (distances && cells[line + x] != emptyCell)
            distances->row(y)[x] =
                1.0f / distanceOfStep(frame, static_cast<std::uint32_t>(cells[line + x] >> indexBits));
    }
}

} // namespace stipple
