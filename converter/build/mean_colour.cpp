#include "converter/build/mean_colour.hpp"

#include <algorithm>
#include <utility>

namespace stipple {

namespace {
// A candidate that is not chosen is nearer than the spacing to one that is, in its own node or beyond its
// face. In the second case the nearest in the node may be far off: then the area is another node's.
constexpr double farthestSpacings = 2;

// Finds the chosen ones that take what others have; asked for candidates in their order.
class Heirs {
  public:
    Heirs(const Candidates& candidates, std::span<const std::uint32_t> representatives,
          const Spacing& spacing, int nodeBits)
        : positions_(candidates.positions), representatives_(representatives),
          weights_(spacing.metric.weights),
          farthest_(farthestSpacings * farthestSpacings * spacing.squaredSteps(nodeBits)) {}

    std::uint32_t of(std::uint32_t i) {
        const std::uint32_t known = representatives_[i];
        return known != nobody ? known : nearestInOrder(i);
    }

  private:
    std::uint32_t nearestInOrder(std::uint32_t i) {
        for (; next_ < representatives_.size() && (next_ <= i || representatives_[next_] != next_); ++next_)
            if (representatives_[next_] == next_)
                before_ = next_;
        std::uint32_t nearest = nobody;
        double least = farthest_;
        for (std::uint32_t other : {before_, next_}) {
            if (other >= representatives_.size())
                continue;
            if (double distance = squaredDistance(i, other); distance < least) {
                least = distance;
                nearest = other;
            }
        }
        return nearest;
    }
    double squaredDistance(std::uint32_t i, std::uint32_t j) const {
        double sum = 0;
        for (int axis = 0; axis < 3; ++axis) {
            auto steps = static_cast<std::int64_t>(positions_[i][axis]) -
                         static_cast<std::int64_t>(positions_[j][axis]);
            const double distance = static_cast<double>(steps) * weights_[axis];
            sum += distance * distance;
        }
        return sum;
    }

    const std::vector<Vec3<std::uint32_t>>& positions_;
    std::span<const std::uint32_t> representatives_;
    Vec3d weights_;
    double farthest_;                          // squared
    std::uint32_t before_ = nobody, next_ = 0; // chosen ones around the last that had no representative
};
} // namespace

ColourRows::ColourRows(const RowLayout& layout, std::span<const int> attributes)
    : channels_(attributes.size()) {
    // A lone intensity three times: sums of as many channels for all clouds, the first of which counts.
    for (std::size_t c = 0; c < offsets_.size() && channels_ > 0; ++c)
        offsets_[c] = layout.offset(attributes[std::min(c, channels_ - 1)]);
}

ColourSum ColourRows::ownSum(const std::uint8_t* row) const {
    ColourSum sum{{}, 1};
    for (std::size_t c = 0; c < offsets_.size(); ++c)
        sum.channels[c] = loadLe<std::uint16_t>(row + offsets_[c]);
    return sum;
}

ColourSum ColourRows::sumOf(const RowLayout& layout, const std::uint8_t* row) const {
    if (layout.extraBytes() == 0)
        return ownSum(row);
    const std::uint8_t* extra = layout.extra(row);
    ColourSum sum{{}, loadLe<std::uint64_t>(extra)};
    for (std::size_t c = 0; c < channels_; ++c)
        sum.channels[c] = loadLe<std::uint64_t>(extra + 8 * (c + 1));
    return sum.points > 0 ? sum : ownSum(row);
}

void ColourRows::writeSum(const ColourSum& sum, std::uint8_t* to) const {
    storeLe(to, sum.points);
    for (std::size_t c = 0; c < channels_; ++c)
        storeLe(to + 8 * (c + 1), sum.channels[c]);
}

MeanColours::MeanColours(const Subtree& subtree, const ColourRows& rows, const Spacing& spacing)
    : subtree_(subtree), rows_(rows), spacing_(spacing), sums_(subtree.nodes().size()),
      shown_(subtree.nodes().size()), isMean_(subtree.nodes().size()) {}

void MeanColours::handOn(std::size_t node, const Candidates& candidates,
                         std::span<const std::uint32_t> representatives) {
    const SubtreeNode& inner = subtree_.nodes()[node];
    Heirs heirs(candidates, representatives, spacing_, subtree_.cube().nodeBits(inner.key.level));
    std::vector<std::uint32_t> places(representatives.size()); // the chosen ones' in the sample
    std::uint32_t chosen = 0;
    for (std::uint32_t i = 0; i < places.size(); ++i) {
        places[i] = chosen;
        chosen += representatives[i] == i ? 1 : 0;
    }
    std::vector<ColourSum>& own = sums_[node];
    own.resize(chosen);
    std::uint32_t i = 0;
    auto take = [&](const ColourSum& sum) {
        if (const std::uint32_t heir = heirs.of(i); heir != nobody)
            own[places[heir]].add(sum);
    };
    for (std::int32_t child : inner.children) {
        if (child < 0)
            continue;
        auto below = static_cast<std::size_t>(child);
        const SubtreeNode& from = subtree_.nodes()[below];
        auto takeOrShow = [&](const ColourSum& sum) {
            take(sum);
            if (representatives[i] != i)
                show(below, sum);
            ++i;
        };
        if (!from.isLeaf) {
            shown_[below].reserve(rows_.channels() * sums_[below].size());
            for (const ColourSum& sum : std::exchange(sums_[below], {}))
                takeOrShow(sum);
        } else if (hasSums(below)) {
            for (std::uint32_t rank = from.first; rank < from.end(); ++rank)
                takeOrShow(rows_.sumOf(subtree_.layout(), subtree_.row(rank)));
        } else {
            for (std::uint32_t rank = from.first; rank < from.end(); ++rank, ++i)
                take(rows_.ownSum(subtree_.row(rank)));
        }
    }
}

void MeanColours::keepBelow(std::size_t node) {
    for (std::int32_t child : subtree_.nodes()[node].children) {
        if (child < 0)
            continue;
        auto below = static_cast<std::size_t>(child);
        const SubtreeNode& from = subtree_.nodes()[below];
        for (std::uint32_t rank = from.first; hasSums(below) && rank < from.end(); ++rank)
            show(below, rows_.sumOf(subtree_.layout(), subtree_.row(rank)));
        for (const ColourSum& sum : std::exchange(sums_[below], {}))
            show(below, sum);
    }
}

bool MeanColours::hasSums(std::size_t node) const {
    return subtree_.nodes()[node].isLeaf && subtree_.layout().extraBytes() > 0;
}

void MeanColours::show(std::size_t node, const ColourSum& sum) {
    std::vector<std::uint16_t>& shown = shown_[node];
    for (std::size_t c = 0; c < rows_.channels(); ++c)
        shown.push_back(static_cast<std::uint16_t>(
            static_cast<double>(sum.channels[c]) / static_cast<double>(sum.points) + 0.5));
    isMean_[node] |= sum.points > 1 ? 1 : 0;
}

std::vector<std::vector<std::uint16_t>> MeanColours::takeShown() {
    if (subtree_.key().level == 0 && !sums_.empty()) // nothing above takes of it
        for (const ColourSum& sum : std::exchange(sums_[0], {}))
            show(0, sum);
    for (std::size_t node = 0; node < shown_.size(); ++node)
        if (isMean_[node] == 0)
            shown_[node].clear();
    return std::move(shown_);
}

std::vector<ColourSum> MeanColours::takeRootSums() {
    std::vector<ColourSum> sums;
    if (sums_.empty())
        return sums;
    const SubtreeNode& root = subtree_.nodes()[0];
    if (!root.isLeaf)
        return std::move(sums_[0]);
    for (std::uint32_t rank = root.first; rank < root.end(); ++rank)
        sums.push_back(rows_.sumOf(subtree_.layout(), subtree_.row(rank)));
    return sums;
}

} // namespace stipple
