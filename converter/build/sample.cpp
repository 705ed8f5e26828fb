#include "converter/build/sample.hpp"

#include "converter/build/disk_sampler.hpp"
#include "converter/build/parallel.hpp"

#include <algorithm>
#include <mutex>
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
    Sampling(const Tiles& tiles, const Spacing& spacing) : tiles_(tiles), spacing_(spacing) {
        samples_.resize(tiles.nodes.size());
        borders_.resize(tiles.nodes.size());
        for (std::size_t i = 0; i < tiles.nodes.size(); ++i)
            indexOf_.emplace(tiles.nodes[i].key, i);
    }

    Result<Sampled> run(int threads, const std::atomic<bool>* stop, const ConvertProgress& progress) {
        workers_.resize(static_cast<std::size_t>(threads));
        // Breadth-first: nodes of one level are neighbours, the deepest last.
        std::size_t end = tiles_.nodes.size();
        while (end > 0) {
            std::size_t begin = end;
            while (begin > 0 && tiles_.nodes[begin - 1].key.level == tiles_.nodes[end - 1].key.level)
                --begin;
            STIPPLE_CHECK(runLevel(begin, end, threads, stop, progress));
            end = begin;
        }
        Sampled result;
        result.rootSpacing = spacing_.world(tiles_.rootCube.bits);
        result.kept = std::move(samples_);
        if (!tiles_.nodes.empty() && tiles_.nodes[0].isLeaf)
            result.kept[0] = everyPoint(tiles_.nodes[0]);
        return result;
    }

  private:
    static std::vector<std::uint32_t> everyPoint(const TileNode& leaf) {
        std::vector<std::uint32_t> ranks(leaf.count);
        std::iota(ranks.begin(), ranks.end(), leaf.first);
        return ranks;
    }

    Status runLevel(std::size_t begin, std::size_t end, int threads, const std::atomic<bool>* stop,
                    const ConvertProgress& progress) {
        std::array<std::vector<std::size_t>, 8> rounds;
        for (std::size_t i = begin; i < end; ++i)
            if (!tiles_.nodes[i].isLeaf)
                rounds[static_cast<std::size_t>(tiles_.nodes[i].key.indexInParent())].push_back(i);
        for (const std::vector<std::size_t>& round : rounds)
            STIPPLE_CHECK(parallelFor(round.size(), threads, stop, [&](std::size_t i, int worker) -> Status {
                sampleNode(round[i], workers_[static_cast<std::size_t>(worker)]);
                report(round[i], progress);
                return {};
            }));
        for (std::size_t i = begin; i < end; ++i)
            borders_[i] = {};
        return {};
    }

    // A point is done when its leaf has been sampled from.
    void report(std::size_t index, const ConvertProgress& progress) {
        std::uint64_t points = 0;
        for (std::int32_t child : tiles_.nodes[index].children)
            if (child >= 0 && tiles_.nodes[static_cast<std::size_t>(child)].isLeaf)
                points += tiles_.nodes[static_cast<std::size_t>(child)].count;
        if (points == 0)
            return;
        std::lock_guard lock(progressMutex_);
        done_ += points;
        progress("sample", done_, tiles_.order.size());
    }

    void sampleNode(std::size_t index, Worker& worker) {
        const TileNode& node = tiles_.nodes[index];
        int bits = tiles_.rootCube.nodeBits(node.key.level);
        for (std::int32_t child : node.children) {
            const std::size_t below = static_cast<std::size_t>(child);
            if (child >= 0 && tiles_.nodes[below].isLeaf)
                samples_[below] = everyPoint(tiles_.nodes[below]);
        }
        if (bits > maxNodeBits)
            return; // too wide to hold points: the children keep theirs
        gather(node, worker);
        worker.sampler.begin(bits, spacing_.metric.weights, spacing_.squaredSteps(bits));
        blockNeighbours(node, worker);
        choose(index, bits, worker);
        shareOut(index, worker);
    }

    void gather(const TileNode& node, Worker& worker) const {
        worker.candidates.clear();
        for (std::int32_t child : node.children)
            if (child >= 0) {
                const auto& sample = samples_[static_cast<std::size_t>(child)];
                worker.candidates.insert(worker.candidates.end(), sample.begin(), sample.end());
            }
        Vec3i corner = tiles_.rootCube.nodeMin(node.key);
        worker.positions.resize(worker.candidates.size());
        for (std::size_t i = 0; i < worker.candidates.size(); ++i) {
            if (i + prefetchAhead < worker.candidates.size())
                tiles_.prefetch(worker.candidates[i + prefetchAhead]);
            Vec3i p = tiles_.position(worker.candidates[i]) - corner;
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

    void blockNeighbours(const TileNode& node, Worker& worker) const {
        int bits = tiles_.rootCube.nodeBits(node.key.level);
        double squaredDistance = spacing_.squaredSteps(bits);
        Vec3i corner = tiles_.rootCube.nodeMin(node.key);
        for (int d = 0; d < 27; ++d) {
            NodeKey key = node.key; // steps below 0 wrap round to keys that do not exist
            key.x += static_cast<std::uint32_t>(d % 3 - 1);
            key.y += static_cast<std::uint32_t>(d / 3 % 3 - 1);
            key.z += static_cast<std::uint32_t>(d / 9 - 1);
            auto found = indexOf_.find(key);
            if (found == indexOf_.end() || key == node.key)
                continue;
            for (Vec3i border : borders_[found->second])
                if (reaches(border - corner, std::int64_t{1} << bits, squaredDistance))
                    worker.sampler.block(border - corner);
        }
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
            for (int axis = 0; axis < 3; ++axis) {
                std::int64_t at = worker.positions[i][axis];
                // To the nearest point a neighbour could have: one step beyond the face.
                double distance =
                    static_cast<double>(std::min(at, last - at) + 1) * spacing_.metric.weights[axis];
                if (distance * distance < squaredDistance && spacing_.metric.weights[axis] > 0) {
                    borders_[index].push_back(tiles_.position(worker.candidates[i]));
                    break;
                }
            }
        }
    }

    // Moves what was taken from the children's samples to the node's.
    void shareOut(std::size_t index, const Worker& worker) {
        std::vector<std::uint32_t>& sample = samples_[index];
        sample.reserve(static_cast<std::size_t>(std::count(worker.taken.begin(), worker.taken.end(), 1)));
        std::size_t at = 0;
        for (std::int32_t child : tiles_.nodes[index].children) {
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

    const Tiles& tiles_;
    const Spacing& spacing_;
    std::vector<Worker> workers_;
    std::unordered_map<NodeKey, std::size_t, NodeKeyHash> indexOf_;
    // Parallel to the nodes: the sample until the parent has chosen, then what is kept.
    std::vector<std::vector<std::uint32_t>> samples_;
    std::vector<std::vector<Vec3i>> borders_; // sample points near the faces; of the level at work
    std::mutex progressMutex_;
    std::uint64_t done_ = 0;
};
} // namespace

Result<Sampled> sample(const Tiles& tiles, const Spacing& spacing, int threads, const std::atomic<bool>* stop,
                       const ConvertProgress& progress) {
    return Sampling(tiles, spacing).run(threads, stop, progress);
}

} // namespace stipple
