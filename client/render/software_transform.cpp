#include "client/render/software_transform.hpp"

#include "client/render/drawn_octree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

// The transform is compiled for the baseline and for wider vectors; all give the same bits, because
// contraction into fused multiply-adds is off. The body is inlined into each.
#if defined(__x86_64__) && defined(__GNUC__)
#define STIPPLE_WIDE_VECTORS 1
#endif
#define STIPPLE_INLINE inline __attribute__((always_inline))

namespace stipple {
namespace {

// A point's rank in its node decides whether it is drawn and how far it has grown (raster_setup.hpp,
// "Detail").
enum class Ranking { prefix, continuous };
// `deep`: orthographic, with positions by integers (raster_setup.hpp, "Deep nodes").
enum class Placing { perspective, orthographic, deep };

STIPPLE_INLINE std::int32_t floorToInt(float value) {
    auto truncated = static_cast<std::int32_t>(value);
    return truncated - (static_cast<float>(truncated) > value ? 1 : 0);
}
STIPPLE_INLINE float clampFloat(float value, float low, float high) {
    value = value < low ? low : value;
    return value > high ? high : value;
}

inline float powerOfTwo(int exponent) {
    return floatOfBits(static_cast<std::uint32_t>(127 + exponent) << 23);
}

STIPPLE_INLINE std::uint32_t rankOf(const std::uint32_t* ranks, std::uint32_t first, std::size_t i) {
    return ranks != nullptr ? ranks[i] : first + static_cast<std::uint32_t>(i);
}

// X of raster_setup.hpp, "Deep nodes".
struct Wrapping {
    const std::uint32_t lowA, lowB, lowC, highA, highB, highC, origin;
    Wrapping(const std::array<std::uint32_t, 3>& low, const std::array<std::uint32_t, 3>& high,
             std::uint32_t at)
        : lowA(low[0]), lowB(low[1]), lowC(low[2]), highA(high[0]), highB(high[1]), highC(high[2]),
          origin(at) {}
};
struct Parts {
    std::uint32_t low, high; // two's complement
};
STIPPLE_INLINE Parts partsOf(std::uint32_t steps) {
    const std::uint32_t low = steps & 0xFFFFu, carry = low >> 15;
    return {low - (carry << 16), static_cast<std::uint32_t>(static_cast<std::int32_t>(steps) >> 16) + carry};
}
STIPPLE_INLINE std::uint32_t wrappedAt(const Wrapping& w, Parts a, Parts b, Parts c) {
    return w.origin + a.low * w.lowA + b.low * w.lowB + c.low * w.lowC + a.high * w.highA + b.high * w.highB +
           c.high * w.highC;
}
// The 1/128-pixel cell that `exact`, modulo 2^(32 - fractionBits) pixels, means near `estimate`.
STIPPLE_INLINE std::int32_t deepCell(float estimate, std::uint32_t exact, int fractionBits) {
    const std::int32_t whole = floorToInt(clampFloat(estimate, -positionLimit, positionLimit));
    const auto apart = static_cast<std::int32_t>(exact - (static_cast<std::uint32_t>(whole) << fractionBits));
    return whole * positionCells + (apart >> (fractionBits - 7));
}
static_assert(positionCells == 1 << 7);

// One loop without branches over the block, for the vectorizer.
template <Placing Place, bool LowWords, Sizing Size, Ranking Rank>
STIPPLE_INLINE void transform(const RasterFrame& frame, const RasterNode& node, Words words,
                              std::size_t count, Block& block) {
    const float ax = node.rowX[0], bx = node.rowX[1], cx = node.rowX[2];
    const float ay = node.rowY[0], by = node.rowY[1], cy = node.rowY[2];
    const float ad = node.rowD[0], bd = node.rowD[1], cd = node.rowD[2];
    const float fx = node.fraction[0], fy = node.fraction[1], fz = node.fraction[2];
    const std::uint32_t cellX = static_cast<std::uint32_t>(node.cell[0]);
    const std::uint32_t cellY = static_cast<std::uint32_t>(node.cell[1]);
    const std::uint32_t cellZ = static_cast<std::uint32_t>(node.cell[2]);
    const float near = frame.near, far = frame.far;
    const float centreX = frame.centreX, centreY = frame.centreY;
    const auto left = static_cast<float>(frame.left), right = static_cast<float>(frame.left + frame.width);
    const auto bottom = static_cast<float>(frame.bottom),
               top = static_cast<float>(frame.bottom + frame.height);
    const std::uint32_t nearBits = frame.nearBits;
    const int depthShift = frame.depthShift;
    const int positionShift = node.positionShift;
    const std::uint32_t lowMask = (1u << positionShift) - 1;
    const auto columns = static_cast<std::uint32_t>(frame.width);
    const auto firstColumn = static_cast<std::uint32_t>(frame.left);
    const auto firstRow = static_cast<std::uint32_t>(frame.bottom);
    const auto lastRow = static_cast<std::uint32_t>(frame.height - 1);
    const std::uint32_t outside = columns * static_cast<std::uint32_t>(frame.height);
    const Wrapping wrapX(node.lowX, node.highX, node.originX), wrapY(node.lowY, node.highY, node.originY);
    const int fractionBits = node.fractionBits;
    const float worldSize64 = frame.worldSize64, nodeSize64 = node.nodeSize64;
    const auto minSize64 = static_cast<float>(frame.minSize64),
               maxSize64 = static_cast<float>(frame.maxSize64);
    const std::uint32_t* ranks = words.ranks;
    const float rankBase = node.rankBase, rankStep = node.rankStep, growth = frame.growth;
    const float falloffX = frame.falloffX, falloffY = frame.falloffY, leastDensity = frame.leastDensity;
    const auto fixedSize64 = static_cast<float>(frame.size64);
    const float pixelSize64 = sizeSteps;
    const bool sizeByDensity = frame.sizeByDensity;

    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t w0 = words.position[2 * i], w1 = words.position[2 * i + 1];
        std::uint32_t px = w0 & 0x1FFFFFu;
        std::uint32_t py = (w0 >> 21) | ((w1 << 10) & 0x1FF800u);
        std::uint32_t pz = w1 >> 11;
        if constexpr (LowWords) {
            const std::uint32_t low = words.low[i];
            px = (px << positionShift) | (low & lowMask);
            py = (py << positionShift) | ((low >> 10) & lowMask);
            pz = (pz << positionShift) | ((low >> 20) & lowMask);
        }
        const std::uint32_t sx = px - cellX, sy = py - cellY, sz = pz - cellZ;
        const float rx = static_cast<float>(static_cast<std::int32_t>(sx)) - fx;
        const float ry = static_cast<float>(static_cast<std::int32_t>(sy)) - fy;
        const float rz = static_cast<float>(static_cast<std::int32_t>(sz)) - fz;

        const float distance = (rx * ad + ry * bd) + rz * cd;
        bool drawn = (distance >= near) & (distance <= far);
        const float d = drawn ? distance : near;
        float x = (rx * ax + ry * bx) + rz * cx;
        float y = (rx * ay + ry * by) + rz * cy;
        if constexpr (Place == Placing::perspective) {
            const float inverse = 1.0f / d;
            x = x * inverse;
            y = y * inverse;
        }
        [[maybe_unused]] float density = 1, grown = 1;
        if constexpr (Rank == Ranking::continuous) {
            const float offX = x * falloffX, offY = y * falloffY;
            density = clampFloat(1.0f - std::sqrt(offX * offX + offY * offY), leastDensity, 1.0f);
            const auto rank = static_cast<float>(static_cast<std::int32_t>(rankOf(ranks, words.rank, i)));
            float q = (rankBase + rankStep * rank) / (density * density);
            if constexpr (Place == Placing::perspective)
                q = q * (d * d);
            drawn = drawn & (q < 1.0f);
            grown = clampFloat((1.0f - q) * growth, 0.0f, 1.0f);
        }
        x = x + centreX;
        y = y + centreY;
        block.step[i] = (std::bit_cast<std::uint32_t>(d) - nearBits) >> depthShift;
        if constexpr (Place == Placing::deep) {
            const Parts a = partsOf(sx), b = partsOf(sy), c = partsOf(sz);
            const std::int32_t cellsX = deepCell(x, wrappedAt(wrapX, a, b, c), fractionBits);
            const std::int32_t cellsY = deepCell(y, wrappedAt(wrapY, a, b, c), fractionBits);
            if constexpr (Size == Sizing::single) {
                const auto column = static_cast<std::uint32_t>(cellsX >> 7) - firstColumn,
                           row = static_cast<std::uint32_t>(cellsY >> 7) - firstRow;
                drawn = drawn & (column < columns) & (row <= lastRow);
                block.pixel[i] = drawn ? (lastRow - row) * columns + column : outside;
            } else {
                block.x[i] = drawn ? cellsX : nowhere;
                block.y[i] = drawn ? cellsY : nowhere;
            }
        } else if constexpr (Size == Sizing::single) {
            // Snapping stays inside its pixel.
            drawn = drawn & (x >= left) & (x < right) & (y >= bottom) & (y < top);
            const auto column =
                static_cast<std::uint32_t>(static_cast<std::int32_t>(drawn ? x : left)) - firstColumn;
            const auto row =
                static_cast<std::uint32_t>(static_cast<std::int32_t>(drawn ? y : bottom)) - firstRow;
            const std::uint32_t pixel = (lastRow - row) * columns + column;
            block.pixel[i] = drawn ? pixel : outside;
        } else {
            x = drawn ? x : -positionLimit;
            block.x[i] = floorToInt(clampFloat(x, -positionLimit, positionLimit) * positionCells);
            block.y[i] = floorToInt(clampFloat(y, -positionLimit, positionLimit) * positionCells);
        }
        if constexpr (Size == Sizing::byDistance) {
            const float size = clampFloat(worldSize64 * (1.0f / d) + 0.5f, minSize64, maxSize64);
            block.size64[i] = static_cast<std::int32_t>(
                Rank == Ranking::continuous ? clampFloat(size * grown, pixelSize64, maxSize64) : size);
        } else if constexpr (Size == Sizing::adaptive) {
            const float scale = Place == Placing::perspective ? 1.0f / d : 1.0f;
            const float size =
                clampFloat(nodeSize64 * block.fineness[i] * scale + 0.5f, minSize64, maxSize64);
            block.size64[i] = static_cast<std::int32_t>(
                Rank == Ranking::continuous ? clampFloat(size * grown, pixelSize64, maxSize64) : size);
        } else if constexpr (Size == Sizing::growing ||
                             (Rank == Ranking::continuous && Size == Sizing::fixed)) {
            float size =
                sizeByDensity ? clampFloat(fixedSize64 / density, minSize64, maxSize64) : fixedSize64;
            if constexpr (Size == Sizing::growing) {
                const float scale = Place == Placing::perspective ? 1.0f / d : 1.0f;
                const float apart = nodeSize64 * block.fineness[i] * scale, most = size * block.doubling[i];
                size = clampFloat(apart < most ? apart : most, size, maxSize64);
            }
            block.size64[i] = static_cast<std::int32_t>(clampFloat(size * grown, pixelSize64, maxSize64));
        }
    }
}

template <Placing P, bool L, Sizing Z, Ranking R>
void transformBaseline(const RasterFrame& frame, const RasterNode& node, Words words, std::size_t count,
                       Block& block) {
    transform<P, L, Z, R>(frame, node, words, count, block);
}

#ifdef STIPPLE_WIDE_VECTORS
template <Placing P, bool L, Sizing Z, Ranking R>
__attribute__((target("avx2"))) void transformAvx2(const RasterFrame& frame, const RasterNode& node,
                                                   Words words, std::size_t count, Block& block) {
    transform<P, L, Z, R>(frame, node, words, count, block);
}
#endif

template <Placing P, bool L, Sizing Z, Ranking R>
Transform chosenTransform() {
#ifdef STIPPLE_WIDE_VECTORS
    if (__builtin_cpu_supports("avx2"))
        return transformAvx2<P, L, Z, R>;
#endif
    return transformBaseline<P, L, Z, R>;
}

template <Sizing Z, Ranking R, Placing P>
Transform transformFor(const RasterNode& node) {
    return node.positionShift > 0 ? chosenTransform<P, true, Z, R>() : chosenTransform<P, false, Z, R>();
}
template <Sizing Z, Ranking R>
Transform transformFor(const RasterFrame& frame, const RasterNode& node) {
    if (frame.perspective)
        return transformFor<Z, R, Placing::perspective>(node);
    return node.deep ? transformFor<Z, R, Placing::deep>(node)
                     : transformFor<Z, R, Placing::orthographic>(node);
}
template <Sizing Z>
Transform transformFor(const RasterFrame& frame, const RasterNode& node) {
    return frame.continuous ? transformFor<Z, Ranking::continuous>(frame, node)
                            : transformFor<Z, Ranking::prefix>(frame, node);
}

} // namespace

Sizing sizingOf(const RasterFrame& frame) {
    if (frame.adaptive)
        return Sizing::adaptive;
    if (frame.growing)
        return Sizing::growing;
    if (frame.sizeByDistance)
        return Sizing::byDistance;
    return frame.size64 == sizeSteps && !frame.sizeByDensity ? Sizing::single : Sizing::fixed;
}

void fillFineness(const std::uint32_t* octree, std::uint32_t place, const ResidentNode& node, Words words,
                  std::size_t count, Block& block) {
    if ((octree[place] & 255u) == 0) {
        const float coarser = (octree[place] & drawnBit) != 0 ? 1.0f : 2.0f;
        std::fill_n(block.fineness.begin(), count, coarser);
        std::fill_n(block.doubling.begin(), count, coarser);
        return;
    }
    const int shift = node.positionShift;
    const std::uint32_t lowMask = (1u << shift) - 1u;
    for (std::size_t i = 0; i < count; ++i) {
        Vec3<std::uint32_t> p = unpackPosition(words.position[2 * i], words.position[2 * i + 1]);
        if (words.low != nullptr)
            p = {(p.x << shift) | (words.low[i] & lowMask), (p.y << shift) | ((words.low[i] >> 10) & lowMask),
                 (p.z << shift) | ((words.low[i] >> 20) & lowMask)};
        const OctreeWalk walk = walkOctree(octree, place, node.nodeBits, p.x, p.y, p.z);
        block.fineness[i] = powerOfTwo(-walk.drawn);
        block.doubling[i] = powerOfTwo(std::min(walk.deepest - walk.drawn, maxDoublings));
    }
}

Transform transformFor(const RasterFrame& frame, const RasterNode& node, Sizing sizing) {
    switch (sizing) {
    case Sizing::single:
        return transformFor<Sizing::single>(frame, node);
    case Sizing::byDistance:
        return transformFor<Sizing::byDistance>(frame, node);
    case Sizing::adaptive:
        return transformFor<Sizing::adaptive>(frame, node);
    case Sizing::growing:
        return transformFor<Sizing::growing>(frame, node);
    case Sizing::fixed:
        break;
    }
    return transformFor<Sizing::fixed>(frame, node);
}

} // namespace stipple
