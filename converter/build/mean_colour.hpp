// The mean colours that inner nodes show (Schütz, Krösl, Wimmer: Continuous level of detail, 2019, §3.1): of
// each point the mean over the area that it stands for, so that coarse pictures don't show a few points'
// noise.
//
// Summed from below, along with the sampling (sample.hpp). A sample point has the sum of the colours, and the
// number, of the points it stands for: in a leaf itself. Of a node's candidates each that is not chosen hands
// what it has on to the chosen one that represents it (Chooser::choose): for a minimum distance the nearest
// of those that excluded it, for a grid the one in its cell. Those that nobody in the node represents - all
// that are not chosen at random, and those that only points of other nodes excluded - hand it on to the
// nearer of the chosen ones before and after them in Morton order, if that is within two spacings; else it
// goes nowhere, as their area is another node's. What a point shows is the mean of its sum on the level where
// it stays. A node whose points each stand for themselves alone, as in leaves, shows their own.
//
// The sums are integers that go the same way whatever the threads, the memory and the order of the inputs.
//
// Plain means of the stored values, not of linear light: pictures are scaled down that way by everyone else,
// and the errors of both differ by less than 1 %.
#pragma once

#include "converter/build/chooser.hpp"

#include <array>

namespace stipple {

struct ColourSum {
    std::array<std::uint64_t, 3> channels{};
    std::uint64_t points = 0;

    void add(const ColourSum& other) {
        for (std::size_t c = 0; c < channels.size(); ++c)
            channels[c] += other.channels[c];
        points += other.points;
    }
};

// The colours in rows: those of the points and, in rows of samples, the sums behind them
// (RowLayout::extraBytes).
class ColourRows {
  public:
    // `attributes`: the picture's (picture_attributes.hpp), each one uint16; none: there is nothing to
    // average.
    ColourRows() = default;
    ColourRows(const RowLayout& layout, std::span<const int> attributes);

    std::size_t channels() const { return channels_; }
    // What rows of samples have in addition.
    std::size_t sumBytes() const { return channels_ > 0 ? 8 * (channels_ + 1) : 0; }
    // Of the row's point alone.
    ColourSum ownSum(const std::uint8_t* row) const;
    // Of a row with or without a sum; one of no points counts as none.
    ColourSum sumOf(const RowLayout& layout, const std::uint8_t* row) const;
    void writeSum(const ColourSum& sum, std::uint8_t* to) const;

  private:
    std::size_t channels_ = 0;
    std::array<std::size_t, 3> offsets_{}; // of the values in a row
};

// The sums and means of one subtree's nodes, level by level from below.
class MeanColours {
  public:
    // Borrows the subtree, the rows and the spacing.
    MeanColours(const Subtree& subtree, const ColourRows& rows, const Spacing& spacing);

    // A node's sample was chosen among those of its children. `representatives`: see Chooser::choose.
    // Thread: any, one for each node.
    void handOn(std::size_t node, const Candidates& candidates,
                std::span<const std::uint32_t> representatives);
    // A node too wide for points: its children keep all of theirs.
    void keepBelow(std::size_t node);

    // In the end, for each node: what the points that it keeps show, channels interleaved; empty: their own
    // colours.
    std::vector<std::vector<std::uint16_t>> takeShown();
    // … and the sums of the sample of the subtree's root.
    std::vector<ColourSum> takeRootSums();

  private:
    bool hasSums(std::size_t node) const; // a leaf whose points came with sums
    void show(std::size_t node, const ColourSum& sum);

    const Subtree& subtree_;
    const ColourRows& rows_;
    const Spacing& spacing_;
    // Parallel to the nodes: of the sample until the parent has chosen …
    std::vector<std::vector<ColourSum>> sums_;
    // … of what is kept, and whether any of that stands for more than itself.
    std::vector<std::vector<std::uint16_t>> shown_;
    std::vector<std::uint8_t> isMean_;
};

} // namespace stipple
