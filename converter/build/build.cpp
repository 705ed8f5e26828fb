#include "converter/build/build.hpp"

#include "converter/build/schedule.hpp"
#include "converter/build/subtree_plan.hpp"
#include "converter/parallel/parallel.hpp"
#include "shared/base/text.hpp"
#include "shared/format/picture_attributes.hpp"

#include <algorithm>
#include <map>
#include <mutex>

namespace stipple {

namespace {
constexpr std::uint64_t sortBytesPerPoint = 40; // keys and indices twice, ranks
// Sums and means of colours: of the two fifths of the points or so that a level's nodes take from leaves.
constexpr std::uint64_t colourBytesPerPoint = 16;
constexpr std::uint64_t encodeBytes = std::uint64_t{1} << 25;
constexpr std::size_t spacingSubtrees = 4; // of which the spacing is estimated

std::uint64_t bytesPerPoint(const RowLayout& layout, const ColourRows& colours) {
    return 2 * layout.rowBytes() + sortBytesPerPoint + (colours.channels() > 0 ? colourBytesPerPoint : 0);
}

ColourRows coloursToAverage(const CloudMetadata& metadata, const RowLayout& layout) {
    return metadata.innerColour == InnerColour::mean ? ColourRows(layout, pictureAttributes(metadata))
                                                     : ColourRows();
}

// A subtree to be built in a tier, or one that is ready for the next.
struct Item {
    NodeKey key;
    std::uint64_t points = 0;
    std::vector<CellRef> cells; // rows in the tiles' cells …
    struct Sample {
        std::uint64_t offset = 0, points = 0;
    };
    std::vector<Sample> samples; // … and in the scratch file
    NodeKeys leaves;             // upper tiers: the nodes that the rows are the samples of
};

bool keyOrder(const Item& a, const Item& b) {
    return a.key < b.key;
}

class Builder {
  public:
    Builder(Tiles& tiles, const CloudMetadata& metadata, const BuildOptions& options, ScratchFile& blocks,
            Journal& journal, const ConvertProgress& progress)
        : tiles_(tiles), metadata_(metadata), options_(options), blocks_(blocks), journal_(journal),
          progress_(progress), colours_(coloursToAverage(metadata, tiles.layout)),
          sampleLayout_(tiles.layout.withExtra(colours_.sumBytes())),
          mostPoints_(options.subtreeBytes / bytesPerPoint(tiles.layout, colours_)),
          mostSamples_(options.subtreeBytes / bytesPerPoint(sampleLayout_, colours_)) {
        for (BuiltSubtree& built : journal.takeBuilt())
            earlier_.emplace(std::make_pair(built.tier, built.key), std::move(built));
    }

    Result<Built> run() {
        STIPPLE_TRY(plan, planSubtrees(tiles_, mostPoints_, options_.stop));
        STIPPLE_CHECK(chooseSpacing(plan));
        std::vector<Item> items;
        for (PlannedSubtree& subtree : plan.subtrees)
            items.push_back({subtree.key, subtree.points, std::move(subtree.cells), {}, {}});
        histograms_ = emptyStatistics(metadata_.schema);
        for (int tier = 0; !items.empty(); ++tier) {
            STIPPLE_TRY(next, runTier(tier, items));
            items = std::move(next);
        }
        return finish();
    }

  private:
    // A small node with nothing below it is as good as its own sample: the tier above takes its rows as they
    // are.
    bool needsWork(int tier, const Item& item) const {
        bool isLeaf = tier > 0 || item.points <= leafCapacity;
        bool canHoldPoints = tiles_.grid.cube.nodeBits(item.key.level) <= maxNodeBits;
        return item.key.level == 0 || !item.leaves.empty() || !isLeaf || !canHoldPoints;
    }

    // Builds the items and returns those of the next tier; none once the root is built.
    Result<std::vector<Item>> runTier(int tier, std::vector<Item>& items) {
        std::vector<Item> ready, work;
        for (Item& item : items)
            (needsWork(tier, item) ? work : ready).push_back(std::move(item));
        std::vector<ScheduledNode> nodes;
        std::vector<BuiltSubtree> built(work.size());
        for (std::size_t i = 0; i < work.size(); ++i) {
            auto found = earlier_.find({tier, work[i].key});
            bool done = found != earlier_.end();
            if (done) {
                built[i] = std::move(found->second);
                report(built[i].points);
            }
            nodes.push_back(
                {work[i].key, work[i].points * bytesPerPoint(layoutOf(tier), colours_) + encodeBytes, done});
        }
        auto before = predecessors(nodes);
        // Alone, an item has all threads to itself; else each has one.
        int inner = work.size() == 1 ? options_.threads : 1;
        int outer = work.size() == 1 ? 1 : options_.threads;
        auto buildItem = [&](std::size_t i) {
            std::vector<const Borders*> borders = bordersAround(work[i].key);
            for (std::size_t earlier : before[i])
                borders.push_back(&built[earlier].borders);
            return buildOne(tier, work[i], borders, inner, built[i]);
        };
        STIPPLE_CHECK(runScheduled(nodes, before, outer, options_.memoryBytes, options_.stop, buildItem));
        for (std::size_t i = 0; i < work.size(); ++i) {
            take(built[i]);
            // The sample may be empty: neighbours took all the room, or the node is too wide to hold points.
            if (work[i].key.level > 0 && built[i].samplePoints > 0)
                ready.push_back({work[i].key,
                                 built[i].samplePoints,
                                 {},
                                 {{built[i].sampleOffset, built[i].samplePoints}},
                                 {}});
            built_.push_back(std::move(built[i]));
        }
        std::sort(ready.begin(), ready.end(), keyOrder);
        trimBorders(ready);
        return plan(std::move(ready));
    }

    // Of the subtrees of earlier tiers that touch `key`.
    std::vector<const Borders*> bordersAround(const NodeKey& key) const {
        std::vector<const Borders*> result;
        for (const BuiltSubtree& built : built_)
            if (!built.borders.empty() && touches(built.key, key))
                result.push_back(&built.borders);
        return result;
    }

    // Upper tiers ask for borders of their own levels only.
    void trimBorders(const std::vector<Item>& ready) {
        int deepest = -1;
        for (const Item& item : ready)
            deepest = std::max(deepest, item.key.level - 1);
        for (BuiltSubtree& built : built_)
            std::erase_if(built.borders, [&](const auto& entry) { return entry.first.level > deepest; });
    }

    // Of the rows of a tier's subtrees: above the first they have sums of colours.
    const RowLayout& layoutOf(int tier) const { return tier == 0 ? tiles_.layout : sampleLayout_; }

    Status loadRows(const RowLayout& layout, const Item& item, bool keep, std::uint8_t* to) {
        const std::size_t rowBytes = layout.rowBytes(), inCell = tiles_.layout.rowBytes();
        auto copy = [&](const std::uint8_t* rows, std::size_t count) -> Status {
            if (rowBytes == inCell)
                std::memcpy(to, rows, count * rowBytes);
            for (std::size_t i = 0; i < count && rowBytes != inCell; ++i) {
                std::memcpy(to + i * rowBytes, rows + i * inCell, inCell);
                std::memset(to + i * rowBytes + inCell, 0, rowBytes - inCell);
            }
            to += count * rowBytes;
            return {};
        };
        for (const CellRef& cell : item.cells)
            STIPPLE_CHECK(cell.store->drain(cell.cell, keep, copy));
        for (const Item::Sample& sample : item.samples) {
            std::size_t size = static_cast<std::size_t>(sample.points) * rowBytes;
            STIPPLE_CHECK(blocks_.read(sample.offset, std::span<std::uint8_t>(to, size)));
            to += size;
        }
        return {};
    }

    // The rows of each cell, then those of each sample, as loadRows() loads them.
    static std::vector<std::size_t> partsOf(const Item& item) {
        std::vector<std::size_t> parts;
        for (const CellRef& cell : item.cells)
            parts.push_back(static_cast<std::size_t>(cell.store->count(cell.cell)));
        for (const Item::Sample& sample : item.samples)
            parts.push_back(static_cast<std::size_t>(sample.points));
        return parts;
    }

    // With `keep` the rows stay in their cells too.
    Result<Subtree> load(const RowLayout& layout, const Item& item, bool keep, SubtreeBuffers& buffers) {
        if (item.points > UINT32_MAX)
            return Error{ErrorCode::limitExceeded,
                         cat(item.points, " points lie at one position, but a node holds at most 2^32 - 1"),
                         "", "thin the input"};
        std::size_t count = static_cast<std::size_t>(item.points);
        STIPPLE_CHECK(loadRows(layout, item, keep, buffers.rows(count, layout.rowBytes())));
        return Subtree(layout, tiles_.grid.cube, item.key, buffers, partsOf(item));
    }

    using Buffers = std::unique_ptr<SubtreeBuffers>;
    Buffers takeBuffers() {
        std::lock_guard lock(mutex_);
        if (buffers_.empty())
            return std::make_unique<SubtreeBuffers>();
        Buffers buffers = std::move(buffers_.back());
        buffers_.pop_back();
        return buffers;
    }
    // Kept only while so many of the largest fit the memory.
    void giveBack(Buffers buffers) {
        std::lock_guard lock(mutex_);
        if ((buffers_.size() + 1) * options_.subtreeBytes <= options_.memoryBytes)
            buffers_.push_back(std::move(buffers));
    }

    Status buildOne(int tier, const Item& item, std::span<const Borders* const> borders, int threads,
                    BuiltSubtree& built) {
        Buffers buffers = takeBuffers();
        STIPPLE_TRY(subtree, load(layoutOf(tier), item, false, *buffers));
        if (item.leaves.empty())
            subtree.splitByCount(leafCapacity);
        else
            subtree.splitTo(item.leaves);
        STIPPLE_TRY(sampled,
                    sample(metadata_.sampling, subtree, spacing_, colours_, borders, threads, options_.stop));
        built.tier = tier;
        built.key = item.key;
        built.borders = std::move(sampled.borders);
        STIPPLE_CHECK(pack(subtree, sampled, threads, built));
        if (item.key.level > 0)
            STIPPLE_CHECK(storeSample(subtree, sampled.kept[0], sampled.rootSums, built));
        giveBack(std::move(buffers));
        std::lock_guard lock(mutex_);
        STIPPLE_CHECK(journal_.add(built));
        for (const CellRef& cell : item.cells)
            cell.store->forget(cell.cell);
        for (const Item::Sample& part : item.samples)
            blocks_.discard(part.offset, part.points * sampleLayout_.rowBytes());
        return {};
    }

    // Encodes what each node keeps; of the subtree's root only if it is the cloud's.
    Status pack(const Subtree& subtree, const Sampled& sampled, int threads, BuiltSubtree& built) {
        struct Packed {
            StoredNode node;
            BatchStatistics statistics;
            PointHash hash;
        };
        const std::vector<SubtreeNode>& nodes = subtree.nodes();
        std::vector<Packed> packed(nodes.size());
        std::vector<PointBatch> batches(static_cast<std::size_t>(threads));
        auto packNode = [&](std::size_t i, int worker) -> Status {
            if (sampled.kept[i].empty() || (i == 0 && subtree.key().level > 0))
                return {};
            PointBatch& batch = batches[static_cast<std::size_t>(worker)];
            subtree.layout().gather(subtree.rows(), sampled.kept[i], batch);
            packed[i].hash.add(metadata_.schema, batch);
            packed[i].statistics = statisticsOf(metadata_.schema, batch);
            std::span<const std::uint16_t> shown;
            if (!sampled.shown.empty())
                shown = sampled.shown[i];
            STIPPLE_TRY(encoded, encodeNode(metadata_, nodes[i].key, batch, shown));
            STIPPLE_TRY(stored, storeNode(encoded, blocks_));
            packed[i].node = std::move(stored);
            report(batch.size());
            return {};
        };
        STIPPLE_CHECK(parallelFor(nodes.size(), threads, options_.stop, packNode));
        built.statistics = emptyStatistics(metadata_.schema);
        for (Packed& node : packed) {
            if (node.node.pointCount == 0)
                continue;
            merge(built.statistics, node.statistics);
            built.hash.add(node.hash);
            built.points += node.node.pointCount;
            built.nodes.push_back(std::move(node.node));
        }
        return {};
    }

    Status storeSample(const Subtree& subtree, const std::vector<std::uint32_t>& ranks,
                       const std::vector<ColourSum>& sums, BuiltSubtree& built) {
        const std::size_t rowBytes = sampleLayout_.rowBytes(), pointBytes = tiles_.layout.rowBytes();
        Bytes rows(ranks.size() * rowBytes);
        for (std::size_t i = 0; i < ranks.size(); ++i) {
            std::memcpy(rows.data() + i * rowBytes, subtree.row(ranks[i]), pointBytes);
            if (!sums.empty())
                colours_.writeSum(sums[i], rows.data() + i * rowBytes + pointBytes);
        }
        built.samplePoints = ranks.size();
        built.sampleOffset = blocks_.reserve(rows.size());
        return blocks_.write(built.sampleOffset, rows);
    }

    void report(std::uint64_t points) {
        std::lock_guard lock(mutex_);
        done_ += points;
        progress_("sample", done_, metadata_.pointCount);
    }

    // The next tier: the largest nodes above `ready` whose samples together are no more than a subtree
    // holds, and those that can't be parted further. What is in none of them waits.
    Result<std::vector<Item>> plan(std::vector<Item> ready) const {
        if (ready.empty())
            return ready; // the root was built
        std::unordered_map<NodeKey, std::uint64_t, NodeKeyHash> points;
        NodeKeys isReady;
        for (const Item& item : ready) {
            isReady.insert(item.key);
            for (NodeKey key = item.key;; key = key.parent()) {
                points[key] += item.points;
                if (key.level == 0)
                    break;
            }
        }
        std::map<NodeKey, Item> next;
        for (Item& item : ready) {
            NodeKey root = itemAbove(item.key, points, isReady);
            Item& into = next[root];
            if (root == item.key) {
                into = std::move(item);
                continue;
            }
            into.key = root;
            into.points += item.points;
            into.cells.insert(into.cells.end(), item.cells.begin(), item.cells.end());
            into.samples.insert(into.samples.end(), item.samples.begin(), item.samples.end());
            into.leaves.insert(item.key);
        }
        std::vector<Item> items;
        for (auto& [key, item] : next)
            items.push_back(std::move(item));
        return items;
    }

    // The node of the next tier that `key` goes to: the highest ancestor that is small enough, or its parent
    // if all of that one's children are ready; else itself, to wait.
    NodeKey itemAbove(const NodeKey& key,
                      const std::unordered_map<NodeKey, std::uint64_t, NodeKeyHash>& points,
                      const NodeKeys& isReady) const {
        NodeKey best = key;
        for (NodeKey at = key; at.level > 0;) {
            at = at.parent();
            if (points.at(at) <= mostSamples_) {
                best = at;
            } else {
                bool allReady = best == key && at == key.parent();
                for (int child = 0; child < 8 && allReady; ++child)
                    allReady = !points.contains(at.child(child)) || isReady.contains(at.child(child));
                return allReady ? at : best;
            }
        }
        return best;
    }

    // From subtrees spread over the cloud.
    Status chooseSpacing(const SubtreePlan& plan) {
        DistanceMetric metric = distanceMetric(metadata_.grid, metadata_.crs);
        if (auto known = journal_.density()) {
            spacing_.metric = metric;
            spacing_.density = *known;
            return {};
        }
        std::vector<const PlannedSubtree*> large;
        for (const PlannedSubtree& subtree : plan.subtrees)
            if (subtree.points > leafCapacity)
                large.push_back(&subtree);
        SpacingEstimate estimate(metric);
        std::size_t chosen = std::min(spacingSubtrees, large.size());
        std::vector<SpacingEstimate> parts(chosen, estimate);
        auto examine = [&](std::size_t i, int) -> Status {
            const PlannedSubtree& from = *large[(2 * i + 1) * large.size() / (2 * chosen)];
            Buffers buffers = takeBuffers();
            STIPPLE_TRY(subtree,
                        load(tiles_.layout, {from.key, from.points, from.cells, {}, {}}, true, *buffers));
            subtree.splitByCount(leafCapacity);
            parts[i].add(subtree);
            giveBack(std::move(buffers));
            return {};
        };
        STIPPLE_CHECK(parallelFor(chosen, options_.threads, options_.stop, examine));
        for (const SpacingEstimate& part : parts)
            estimate.add(part);
        spacing_ = estimate.choose(metadata_.sampling);
        return journal_.setDensity(spacing_.density);
    }

    // What stays of a built subtree, which is much less.
    void take(BuiltSubtree& built) {
        for (std::size_t a = 0; a < histograms_.size(); ++a) {
            histograms_[a].merge(built.statistics[a]);
            built.statistics[a].histogram.reset();
        }
    }

    Result<Built> finish() {
        Built result;
        result.spacing = spacing_;
        result.statistics = emptyStatistics(metadata_.schema);
        // In the order of the tiers and of the keys: sums of doubles depend on it.
        for (BuiltSubtree& built : built_) {
            merge(result.statistics, built.statistics);
            result.hash.add(built.hash);
            result.points += built.points;
            std::move(built.nodes.begin(), built.nodes.end(), std::back_inserter(result.nodes));
        }
        for (std::size_t a = 0; a < histograms_.size(); ++a)
            result.statistics[a].histogram = std::move(histograms_[a].histogram);
        return result;
    }

    Tiles& tiles_;
    const CloudMetadata& metadata_;
    const BuildOptions& options_;
    ScratchFile& blocks_;
    Journal& journal_;
    const ConvertProgress& progress_;
    const ColourRows colours_; // that inner nodes show the means of
    const RowLayout sampleLayout_;
    // Of a subtree in the first tier, and of one made of samples.
    const std::uint64_t mostPoints_, mostSamples_;
    Spacing spacing_;
    std::map<std::pair<int, NodeKey>, BuiltSubtree> earlier_; // of an earlier run
    std::vector<BuiltSubtree> built_;                         // tier by tier, in the order of the keys
    BatchStatistics histograms_;                              // over all of them; the rest of it is unused
    std::mutex mutex_;
    std::vector<Buffers> buffers_; // not in use
    std::uint64_t done_ = 0;
};
} // namespace

Result<Built> build(Tiles& tiles, const CloudMetadata& metadata, const BuildOptions& options,
                    ScratchFile& blocks, Journal& journal, const ConvertProgress& progress) {
    return Builder(tiles, metadata, options, blocks, journal, progress).run();
}

} // namespace stipple
