#include "converter/build/sample.hpp"

#include "converter/parallel/parallel.hpp"

#include <algorithm>
#include <numeric>

namespace stipple {

namespace {
// What one thread works with.
struct Worker {
    Candidates candidates;
    std::vector<std::uint32_t> representatives; // parallel to the candidates
};

class Sampler {
  public:
    Sampler(const Subtree& subtree, Chooser& chooser, MeanColours* means, int threads)
        : subtree_(subtree), nodes_(subtree.nodes()), chooser_(chooser), means_(means),
          workers_(static_cast<std::size_t>(threads)), samples_(nodes_.size()) {}

    Result<Sampled> run(const std::atomic<bool>* stop) {
        // Breadth-first: nodes of one level are neighbours, the deepest last.
        std::size_t end = nodes_.size();
        while (end > 0) {
            std::size_t begin = end;
            while (begin > 0 && nodes_[begin - 1].key.level == nodes_[end - 1].key.level)
                --begin;
            STIPPLE_CHECK(runLevel(begin, end, stop));
            end = begin;
        }
        if (!nodes_.empty() && nodes_[0].isLeaf)
            samples_[0] = everyPoint(nodes_[0]);
        Sampled sampled{std::move(samples_), {}, {}, chooser_.takeBorders()};
        if (means_ != nullptr) {
            sampled.shown = means_->takeShown();
            sampled.rootSums = means_->takeRootSums();
        }
        return sampled;
    }

  private:
    static std::vector<std::uint32_t> everyPoint(const SubtreeNode& leaf) {
        std::vector<std::uint32_t> ranks(leaf.count);
        std::iota(ranks.begin(), ranks.end(), leaf.first);
        return ranks;
    }

    Status runLevel(std::size_t begin, std::size_t end, const std::atomic<bool>* stop) {
        std::array<std::vector<std::size_t>, 8> rounds;
        for (std::size_t i = begin; i < end; ++i)
            if (!nodes_[i].isLeaf) {
                int round = chooser_.heedsNeighbours() ? nodes_[i].key.indexInParent() : 0;
                rounds[static_cast<std::size_t>(round)].push_back(i);
            }
        for (const std::vector<std::size_t>& round : rounds)
            STIPPLE_CHECK(parallelFor(round.size(), static_cast<int>(workers_.size()), stop,
                                      [&](std::size_t i, int worker) -> Status {
                                          sampleNode(round[i], worker);
                                          return {};
                                      }));
        chooser_.finishLevel(begin, end);
        return {};
    }

    void sampleNode(std::size_t index, int worker) {
        const SubtreeNode& node = nodes_[index];
        for (std::int32_t child : node.children) {
            const std::size_t below = static_cast<std::size_t>(child);
            if (child >= 0 && nodes_[below].isLeaf)
                samples_[below] = everyPoint(nodes_[below]);
        }
        if (subtree_.cube().nodeBits(node.key.level) > maxNodeBits) {
            if (means_ != nullptr)
                means_->keepBelow(index);
            return; // too wide to hold points: the children keep theirs
        }
        auto& [candidates, representatives] = workers_[static_cast<std::size_t>(worker)];
        gather(index, candidates);
        representatives.resize(candidates.ranks.size());
        chooser_.choose(candidates, worker, representatives);
        if (means_ != nullptr)
            means_->handOn(index, candidates, representatives);
        shareOut(index, representatives);
    }

    void gather(std::size_t index, Candidates& candidates) const {
        candidates.node = index;
        candidates.ranks.clear();
        for (std::int32_t child : nodes_[index].children)
            if (child >= 0) {
                const auto& sample = samples_[static_cast<std::size_t>(child)];
                candidates.ranks.insert(candidates.ranks.end(), sample.begin(), sample.end());
            }
        Vec3i corner = subtree_.cube().nodeMin(nodes_[index].key);
        candidates.positions.resize(candidates.ranks.size());
        for (std::size_t i = 0; i < candidates.ranks.size(); ++i) {
            Vec3i p = subtree_.position(candidates.ranks[i]) - corner;
            candidates.positions[i] = {static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y),
                                       static_cast<std::uint32_t>(p.z)};
        }
    }

    // Moves what was chosen from the children's samples to the node's.
    void shareOut(std::size_t index, const std::vector<std::uint32_t>& representatives) {
        std::vector<std::uint32_t>& sample = samples_[index];
        std::size_t chosen = 0;
        for (std::uint32_t i = 0; i < representatives.size(); ++i)
            chosen += representatives[i] == i ? 1 : 0;
        sample.reserve(chosen);
        std::uint32_t at = 0;
        for (std::int32_t child : nodes_[index].children) {
            if (child < 0)
                continue;
            std::vector<std::uint32_t>& below = samples_[static_cast<std::size_t>(child)];
            std::size_t kept = 0;
            for (std::uint32_t rank : below) {
                if (representatives[at] == at)
                    sample.push_back(rank);
                else
                    below[kept++] = rank;
                ++at;
            }
            below.resize(kept);
            below.shrink_to_fit();
        }
    }

    const Subtree& subtree_;
    const std::vector<SubtreeNode>& nodes_;
    Chooser& chooser_;
    MeanColours* means_; // null: nothing to average
    std::vector<Worker> workers_;
    // Parallel to the nodes: the sample until the parent has chosen, then what is kept.
    std::vector<std::vector<std::uint32_t>> samples_;
};
} // namespace

Result<Sampled> sample(Sampling sampling, const Subtree& subtree, const Spacing& spacing,
                       const ColourRows& colours, std::span<const Borders* const> neighbours, int threads,
                       const std::atomic<bool>* stop) {
    const bool isMean = colours.channels() > 0;
    auto chooser = makeChooser(sampling, subtree, spacing, neighbours, threads, isMean);
    MeanColours means(subtree, colours, spacing);
    return Sampler(subtree, *chooser, isMean ? &means : nullptr, threads).run(stop);
}

} // namespace stipple
