#include "converter/synth/bvh.hpp"

#include <algorithm>
#include <numeric>

namespace stipple::synth {

namespace {

constexpr int binCount = 16;
// Below this level ranges are halved whatever the cost, so that the depth stays under what a traversal's
// stack holds: 20 + log4(2^32) levels with 3 waiting children each.
constexpr int halvingDepth = 20;

float halfArea(const Box<float>& box) {
    if (box.empty())
        return 0;
    float x = box.max.x - box.min.x, y = box.max.y - box.min.y, z = box.max.z - box.min.z;
    return x * y + y * z + z * x;
}

struct Split {
    int axis = -1;
    float cost = 0;
    int bin = 0;
};

} // namespace

struct Bvh::Build {
    std::span<const Box<float>> boxes;
    std::vector<std::uint32_t>& order;
    std::vector<Node>& nodes;
    std::size_t maxLeafItems;

    struct Range {
        std::size_t first, count;
        Box<float> box, centres;
    };

    Vec3f centre(std::uint32_t item) const { return (boxes[item].min + boxes[item].max) * 0.5f; }

    Range rangeOf(std::size_t first, std::size_t count) const {
        Range range{first, count, {}, {}};
        for (std::size_t i = first; i < first + count; ++i) {
            range.box.extend(boxes[order[i]]);
            range.centres.extend(centre(order[i]));
        }
        return range;
    }

    int binOf(const Range& range, int axis, std::uint32_t item) const {
        float from = range.centres.min[axis], size = range.centres.max[axis] - from;
        int bin = static_cast<int>((centre(item)[axis] - from) / size * static_cast<float>(binCount));
        return std::clamp(bin, 0, binCount - 1);
    }

    // The cheapest plane between bins over the longest axis of centres; axis -1 where all centres coincide.
    Split bestSplit(const Range& range) const {
        Split best;
        Vec3f size = range.centres.max - range.centres.min;
        int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        if (!(size[axis] > 0))
            return best;
        std::array<Box<float>, binCount> box;
        std::array<std::size_t, binCount> count{};
        for (std::size_t i = range.first; i < range.first + range.count; ++i) {
            auto bin = static_cast<std::size_t>(binOf(range, axis, order[i]));
            box[bin].extend(boxes[order[i]]);
            ++count[bin];
        }
        std::array<float, binCount> rightCost{};
        Box<float> right;
        std::size_t rightCount = 0;
        for (std::size_t bin = binCount; bin-- > 1;) {
            right.extend(box[bin]);
            rightCount += count[bin];
            rightCost[bin] = halfArea(right) * static_cast<float>(rightCount);
        }
        Box<float> left;
        std::size_t leftCount = 0;
        for (std::size_t bin = 1; bin < binCount; ++bin) {
            left.extend(box[bin - 1]);
            leftCount += count[bin - 1];
            float cost = halfArea(left) * static_cast<float>(leftCount) + rightCost[bin];
            if (leftCount > 0 && leftCount < range.count && (best.axis < 0 || cost < best.cost))
                best = {axis, cost, static_cast<int>(bin)};
        }
        return best;
    }

    std::array<Range, 2> cut(const Range& range, int depth) {
        Split split = depth < halvingDepth ? bestSplit(range) : Split{};
        std::size_t leftCount = range.count / 2;
        if (split.axis >= 0) {
            auto first = order.begin() + static_cast<std::ptrdiff_t>(range.first);
            auto middle = std::partition(
                first, first + static_cast<std::ptrdiff_t>(range.count),
                [&](std::uint32_t item) { return binOf(range, split.axis, item) < split.bin; });
            leftCount = static_cast<std::size_t>(middle - first);
        }
        return {rangeOf(range.first, leftCount), rangeOf(range.first + leftCount, range.count - leftCount)};
    }

    // Fills node `at` with up to four parts of `range`: the largest part is cut until there are four.
    void fill(std::size_t at, const Range& range, int depth) {
        std::array<Range, 4> parts{range};
        std::size_t count = 1;
        while (count < 4) {
            std::size_t widest = 4;
            for (std::size_t i = 0; i < count; ++i)
                if (parts[i].count > maxLeafItems &&
                    (widest == 4 || halfArea(parts[i].box) > halfArea(parts[widest].box)))
                    widest = i;
            if (widest == 4)
                break;
            auto halves = cut(parts[widest], depth);
            parts[widest] = halves[0];
            parts[count++] = halves[1];
        }
        for (std::size_t i = 0; i < 4; ++i) {
            bool used = i < count;
            for (int axis = 0; axis < 3; ++axis) {
                auto plane = static_cast<std::size_t>(axis) * 2;
                constexpr float far = std::numeric_limits<float>::max();
                nodes[at].planes[plane][i] = used ? parts[i].box.min[axis] - padding : far;
                nodes[at].planes[plane + 1][i] = used ? parts[i].box.max[axis] + padding : -far;
            }
            nodes[at].child[i] = 0;
            nodes[at].count[i] = 0;
        }
        for (std::size_t i = 0; i < count; ++i) {
            bool leaf = parts[i].count <= maxLeafItems;
            std::size_t child = leaf ? parts[i].first : nodes.size();
            nodes[at].child[i] = static_cast<std::uint32_t>(child);
            nodes[at].count[i] = leaf ? static_cast<std::uint32_t>(parts[i].count) : 0;
            if (!leaf) {
                nodes.emplace_back();
                fill(child, parts[i], depth + 1);
            }
        }
    }
};

Bvh::Bvh(std::span<const Box<float>> boxes, std::vector<std::uint32_t>& order, std::size_t leafItems) {
    order.resize(boxes.size());
    std::iota(order.begin(), order.end(), 0u);
    if (boxes.empty())
        return;
    Build build{boxes, order, nodes_, leafItems};
    auto range = build.rangeOf(0, boxes.size());
    bounds_ = range.box;
    nodes_.emplace_back();
    build.fill(0, range, 0);
}

} // namespace stipple::synth
