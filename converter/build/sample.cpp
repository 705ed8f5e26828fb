#include "converter/build/sample.hpp"

#include "converter/build/disk_sampler.hpp"
#include "converter/build/parallel.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace stipple {

namespace {
// What one thread works with.
struct Worker {
    DiskSampler sampler;
    std::vector<std::uint32_t> candidates;      // ranks, rising
    std::vector<Vec3<std::uint32_t>> positions; // of the candidates, in steps from the node's corner
    std::vector<std::uint8_t> taken;            // parallel to candidates
};

// Points are visited in blocks of so many neighbours in Morton order, and spread evenly inside a block: the
// cells they look into stay in the cache.
constexpr int visitBits = 12;
constexpr std::uint32_t visitBlock = 1u << visitBits;
constexpr std::size_t prefetchAhead = 24;

constexpr std::uint32_t reversedBits(std::uint32_t value) {
    std::uint32_t result = 0;
    for (int i = 0; i < visitBits; ++i)
        result |= (value >> i & 1u) << (visitBits - 1 - i);
    return result;
}

class Sampling {
  public:
    Sampling(const Subtree& subtree, const Spacing& spacing, std::span<const Borders* const> neighbours)
        : subtree_(subtree), nodes_(subtree.nodes()), spacing_(spacing), neighbours_(neighbours) {
        samples_.resize(nodes_.size());
        borders_.resize(nodes_.size());
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            indexOf_.emplace(nodes_[i].key, i);
    }

    Result<Sampled> run(int threads, const std::atomic<bool>* stop) {
        workers_.resize(static_cast<std::size_t>(threads));
        // Breadth-first: nodes of one level are neighbours, the deepest last.
        std::size_t end = nodes_.size();
        while (end > 0) {
            std::size_t begin = end;
            while (begin > 0 && nodes_[begin - 1].key.level == nodes_[end - 1].key.level)
                --begin;
            STIPPLE_CHECK(runLevel(begin, end, threads, stop));
            end = begin;
        }
        if (!nodes_.empty() && nodes_[0].isLeaf)
            samples_[0] = everyPoint(nodes_[0]);
        return Sampled{std::move(samples_), std::move(outer_)};
    }

  private:
    static std::vector<std::uint32_t> everyPoint(const SubtreeNode& leaf) {
        std::vector<std::uint32_t> ranks(leaf.count);
        std::iota(ranks.begin(), ranks.end(), leaf.first);
        return ranks;
    }

    Status runLevel(std::size_t begin, std::size_t end, int threads, const std::atomic<bool>* stop) {
        std::array<std::vector<std::size_t>, 8> rounds;
        for (std::size_t i = begin; i < end; ++i)
            if (!nodes_[i].isLeaf)
                rounds[static_cast<std::size_t>(nodes_[i].key.indexInParent())].push_back(i);
        for (const std::vector<std::size_t>& round : rounds)
            STIPPLE_CHECK(parallelFor(round.size(), threads, stop, [&](std::size_t i, int worker) -> Status {
                sampleNode(round[i], workers_[static_cast<std::size_t>(worker)]);
                return {};
            }));
        for (std::size_t i = begin; i < end; ++i)
            publishBorder(i);
        return {};
    }

    // Other subtrees have to know of what lies near the subtree's own faces.
    void publishBorder(std::size_t index) {
        const NodeKey& key = nodes_[index].key;
        int bits = subtree_.cube().nodeBits(key.level),
            rootBits = subtree_.cube().nodeBits(subtree_.key().level);
        double squaredDistance = spacing_.squaredSteps(bits);
        Vec3i corner = subtree_.cube().nodeMin(subtree_.key());
        std::int64_t last = (std::int64_t{1} << rootBits) - 1;
        std::vector<Vec3i> outer;
        for (Vec3i border : borders_[index])
            if (nearFace(border - corner, last, squaredDistance))
                outer.push_back(border);
        if (!outer.empty())
            outer_.emplace(key, std::move(outer));
        borders_[index] = {};
    }

    void sampleNode(std::size_t index, Worker& worker) {
        const SubtreeNode& node = nodes_[index];
        int bits = subtree_.cube().nodeBits(node.key.level);
        for (std::int32_t child : node.children) {
            const std::size_t below = static_cast<std::size_t>(child);
            if (child >= 0 && nodes_[below].isLeaf)
                samples_[below] = everyPoint(nodes_[below]);
        }
        if (bits > maxNodeBits)
            return; // too wide to hold points: the children keep theirs
        gather(node, worker);
        worker.sampler.begin(bits, spacing_.metric.weights, spacing_.squaredSteps(bits));
        blockNeighbours(node, worker);
        choose(index, bits, worker);
        shareOut(index, worker);
    }

    void gather(const SubtreeNode& node, Worker& worker) const {
        worker.candidates.clear();
        for (std::int32_t child : node.children)
            if (child >= 0) {
                const auto& sample = samples_[static_cast<std::size_t>(child)];
                worker.candidates.insert(worker.candidates.end(), sample.begin(), sample.end());
            }
        Vec3i corner = subtree_.cube().nodeMin(node.key);
        worker.positions.resize(worker.candidates.size());
        for (std::size_t i = 0; i < worker.candidates.size(); ++i) {
            Vec3i p = subtree_.position(worker.candidates[i]) - corner;
            worker.positions[i] = {static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y),
                                   static_cast<std::uint32_t>(p.z)};
        }
    }

    // Whether `p`, in steps from the node's corner, is within the minimum distance of the node's box on the
    // axis, seen from outside.
    bool reaches(Vec3i p, std::int64_t side, double squaredDistance) const {
        double sum = 0;
        for (int axis = 0; axis < 3; ++axis) {
            std::int64_t out = p[axis] < 0 ? -p[axis] : p[axis] >= side ? p[axis] - (side - 1) : 0;
            double distance = static_cast<double>(out) * spacing_.metric.weights[axis];
            sum += distance * distance;
        }
        return sum < squaredDistance;
    }

    void blockNeighbours(const SubtreeNode& node, Worker& worker) const {
        int bits = subtree_.cube().nodeBits(node.key.level);
        Vec3i corner = subtree_.cube().nodeMin(node.key);
        for (int d = 0; d < 27; ++d) {
            NodeKey key = node.key; // steps below 0 wrap round to keys that do not exist
            key.x += static_cast<std::uint32_t>(d % 3 - 1);
            key.y += static_cast<std::uint32_t>(d / 3 % 3 - 1);
            key.z += static_cast<std::uint32_t>(d / 9 - 1);
            if (key == node.key)
                continue;
            if (auto found = indexOf_.find(key); found != indexOf_.end())
                block(borders_[found->second], corner, bits, worker);
            else
                for (const Borders* borders : neighbours_)
                    if (auto outside = borders->find(key); outside != borders->end())
                        block(outside->second, corner, bits, worker);
        }
    }

    void block(const std::vector<Vec3i>& borders, Vec3i corner, int bits, Worker& worker) const {
        double squaredDistance = spacing_.squaredSteps(bits);
        for (Vec3i border : borders)
            if (reaches(border - corner, std::int64_t{1} << bits, squaredDistance))
                worker.sampler.block(border - corner);
    }

    void choose(std::size_t index, int bits, Worker& worker) {
        auto count = static_cast<std::uint32_t>(worker.candidates.size());
        worker.taken.assign(count, 0);
        for (std::uint32_t block = 0; block < count; block += visitBlock)
            for (std::uint32_t i = 0; i < visitBlock; ++i) {
                std::uint32_t at = block + reversedBits(i);
                if (at >= count)
                    continue;
                Vec3<std::uint32_t> p = worker.positions[at];
                worker.taken[at] = worker.sampler.accept({p.x, p.y, p.z}) ? 1 : 0;
            }
        noteBorder(index, bits, worker);
    }

    // Keeps the taken points that a neighbour has to know of.
    void noteBorder(std::size_t index, int bits, const Worker& worker) {
        double squaredDistance = spacing_.squaredSteps(bits);
        std::int64_t last = (std::int64_t{1} << bits) - 1;
        for (std::size_t i = 0; i < worker.candidates.size(); ++i) {
            if (worker.taken[i] == 0)
                continue;
            Vec3<std::uint32_t> p = worker.positions[i];
            if (nearFace({p.x, p.y, p.z}, last, squaredDistance))
                borders_[index].push_back(subtree_.position(worker.candidates[i]));
        }
    }

    // Whether a point beyond a face of a cube of `last` + 1 steps could be too near to `p` in it.
    bool nearFace(Vec3i p, std::int64_t last, double squaredDistance) const {
        for (int axis = 0; axis < 3; ++axis) {
            // To the nearest point a neighbour could have: one step beyond the face.
            double distance =
                static_cast<double>(std::min(p[axis], last - p[axis]) + 1) * spacing_.metric.weights[axis];
            if (distance * distance < squaredDistance && spacing_.metric.weights[axis] > 0)
                return true;
        }
        return false;
    }

    // Moves what was taken from the children's samples to the node's.
    void shareOut(std::size_t index, const Worker& worker) {
        std::vector<std::uint32_t>& sample = samples_[index];
        sample.reserve(static_cast<std::size_t>(std::count(worker.taken.begin(), worker.taken.end(), 1)));
        std::size_t at = 0;
        for (std::int32_t child : nodes_[index].children) {
            if (child < 0)
                continue;
            std::vector<std::uint32_t>& below = samples_[static_cast<std::size_t>(child)];
            std::size_t kept = 0;
            for (std::uint32_t rank : below) {
                if (worker.taken[at++] != 0)
                    sample.push_back(rank);
                else
                    below[kept++] = rank;
            }
            below.resize(kept);
            below.shrink_to_fit();
        }
    }

    const Subtree& subtree_;
    const std::vector<SubtreeNode>& nodes_;
    const Spacing& spacing_;
    std::span<const Borders* const> neighbours_;
    std::vector<Worker> workers_;
    std::unordered_map<NodeKey, std::size_t, NodeKeyHash> indexOf_;
    // Parallel to the nodes: the sample until the parent has chosen, then what is kept.
    std::vector<std::vector<std::uint32_t>> samples_;
    std::vector<std::vector<Vec3i>> borders_; // sample points near the faces; of the level at work
    Borders outer_;
};
} // namespace

Result<Sampled> sample(const Subtree& subtree, const Spacing& spacing,
                       std::span<const Borders* const> neighbours, int threads,
                       const std::atomic<bool>* stop) {
    return Sampling(subtree, spacing, neighbours).run(threads, stop);
}

} // namespace stipple
