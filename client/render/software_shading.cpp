#include "client/render/software_shading.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace stipple {

std::uint32_t colourOf(const DrawNode& node, std::size_t point) {
    const std::vector<std::uint32_t>& words = node.colourWords();
    return words.empty() ? plainColourWord : words[point] | 0xFF000000u;
}

namespace {

// Base-2 logarithm of a normal number >= 1, to 2e-7: x = 2^e × m with m in [√½, √2), and
// ln m = 2 atanh(t), t = (m - 1) / (m + 1), |t| < 0.172; the first term left out is t^9 / 9.
// Written out, not std::log2, so that the loop is vectorized and every machine gives the same bits.
inline float log2Of(float x) {
    constexpr std::uint32_t rootHalfBits = 0x3F3504F3; // √½
    std::uint32_t offset = std::bit_cast<std::uint32_t>(x) - rootHalfBits;
    std::int32_t exponent = static_cast<std::int32_t>(offset) >> 23;
    float m = std::bit_cast<float>((offset & 0x007FFFFFu) + rootHalfBits);
    float t = (m - 1) / (m + 1);
    float t2 = t * t;
    float series = t * (1.0f + t2 * (1.0f / 3 + t2 * (1.0f / 5 + t2 * (1.0f / 7))));
    return static_cast<float>(exponent) + series * 2.8853900818f; // 2 / ln 2
}

// 2^x for -126 <= x <= 0, to 2e-7: nearest integer n, and the series of e^(f ln 2) for |f| <= 1/2.
inline float exp2Of(float x) {
    auto n = static_cast<std::int32_t>(x - 0.5f);
    float f = (x - static_cast<float>(n)) * 0.69314718056f;
    float series =
        1 + f * (1 + f * (1.0f / 2 + f * (1.0f / 6 + f * (1.0f / 24 + f * (1.0f / 120 + f * (1.0f / 720))))));
    return series * std::bit_cast<float>(static_cast<std::uint32_t>(n + 127) << 23);
}

} // namespace

void InverseDistances::resize(int width, int height, const EdlSetup& edl) {
    int reach = 0;
    for (const auto& offset : edl.offsets)
        reach = std::max({reach, std::abs(offset[0]), std::abs(offset[1])});
    margin = reach;
    stride = static_cast<std::size_t>(width + 2 * margin);
    values.assign(stride * static_cast<std::size_t>(height + 2 * margin), 0.0f);
}

void colourRow(const FramePlan& plan, const RasterFrame& frame, const std::vector<PlacedNode>& nodes,
               const std::uint64_t* cells, int y, Image& image, InverseDistances* distances) {
    const auto& b = plan.style.background;
    const std::uint32_t background =
        b[0] | std::uint32_t{b[1]} << 8 | std::uint32_t{b[2]} << 16 | 0xFF000000u;
    auto width = static_cast<std::size_t>(frame.width);
    const std::uint64_t* line = cells + static_cast<std::size_t>(y) * width;
    std::uint8_t* out = image.rgba.data() + 4 * static_cast<std::size_t>(y) * width;
    float* inverse = distances ? distances->row(y) : nullptr;
    const PlacedNode* placed = nodes.data();
    for (std::size_t x = 0; x < width; ++x) {
        std::uint32_t word = background;
        if (line[x] != emptyCell) {
            std::uint64_t index = line[x] & indexMask;
            std::uint64_t place = index - placed->firstIndex; // wraps for an earlier node
            if (place >= placed->draw->pointCount) {
                auto next =
                    std::upper_bound(nodes.begin(), nodes.end(), index,
                                     [](std::uint64_t i, const PlacedNode& n) { return i < n.firstIndex; });
                placed = &*(next - 1);
                place = index - placed->firstIndex;
            }
            word = colourOf(*placed->draw, static_cast<std::size_t>(place));
            if (inverse) {
                auto step = static_cast<std::uint32_t>(line[x] >> indexBits);
                inverse[x] = 1.0f / distanceOfStep(frame, step);
            }
        }
        std::memcpy(out + 4 * x, &word, 4);
    }
}

void shadeRow(const EdlSetup& edl, const InverseDistances& distances, int y, Image& image) {
    constexpr std::size_t blockPixels = 256;
    std::array<float, blockPixels> distance, product, shade;
    auto width = static_cast<std::size_t>(image.width);
    std::uint8_t* out = image.rgba.data() + 4 * static_cast<std::size_t>(y) * width;
    for (std::size_t first = 0; first < width; first += blockPixels) {
        std::size_t count = std::min(blockPixels, width - first);
        const float* middle = distances.row(y) + first;
        // An empty pixel gets distance 0, an empty neighbour has inverse 0: neither adds to a product.
        for (std::size_t x = 0; x < count; ++x)
            distance[x] = middle[x] > 0 ? 1.0f / middle[x] : 0.0f;
        product.fill(1.0f);
        for (int i = 0; i < edl.neighbours; ++i) {
            const auto& offset = edl.offsets[static_cast<std::size_t>(i)];
            const float* neighbour = distances.row(y - offset[1]) + first + offset[0]; // offsets: y up
            for (std::size_t x = 0; x < count; ++x) {
                float ratio = distance[x] * neighbour[x];
                product[x] = product[x] * (ratio > 1.0f ? ratio : 1.0f);
            }
        }
        for (std::size_t x = 0; x < count; ++x) {
            float p = product[x] < edlProductLimit ? product[x] : edlProductLimit;
            float exponent = -log2Of(p) * edl.power;
            shade[x] = exp2Of(exponent > -126.0f ? exponent : -126.0f);
        }
        for (std::size_t x = 0; x < count; ++x)
            for (std::size_t c = 0; c < 3; ++c) {
                std::uint8_t& level = out[4 * (first + x) + c];
                level = static_cast<std::uint8_t>(static_cast<float>(level) * shade[x] + 0.5f);
            }
    }
}

} // namespace stipple
