#include "converter/export/walk_points.hpp"

#include "converter/export/encode_pieces.hpp"
#include "converter/export/ordered_work.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <memory>
#include <new>

namespace stipple {

namespace {

constexpr std::size_t nodesPerThread = 4;
constexpr std::uint64_t maxPointsWaiting = 2'000'000;
constexpr std::size_t maxPointsEncoded = 1 << 18; // ahead of writing: text takes many times what points do

// `to` has room for them.
void gather(const Bytes& from, std::span<const std::uint32_t> rows, std::size_t size, std::uint8_t* to) {
    auto gatherAs = [&](auto width) {
        for (std::size_t i = 0; i < rows.size(); ++i)
            std::memcpy(to + i * width, from.data() + rows[i] * width, width);
    };
    switch (size) { // a constant width lets the compiler turn the copy into one move
    case 1:
        return gatherAs(std::integral_constant<std::size_t, 1>{});
    case 2:
        return gatherAs(std::integral_constant<std::size_t, 2>{});
    case 4:
        return gatherAs(std::integral_constant<std::size_t, 4>{});
    case 8:
        return gatherAs(std::integral_constant<std::size_t, 8>{});
    default:
        return gatherAs(size);
    }
}

// A node's points, chosen; encoded unless there are too many.
struct Chosen {
    int level = 0;
    std::uint64_t nodePoints = 0;
    bool tested = false;
    CloudFilter::Dropped dropped;
    std::uint64_t taken = 0;
    PointBatch batch;
    std::vector<EncodedPoints> encoded; // in order
};

class Walk {
  public:
    Walk(CloudReader& reader, const std::string& name, const CloudFilter& filter,
         const std::vector<int>& attributes, PointSink* sink, const WalkOptions& options)
        : reader_(reader), name_(name), filter_(filter), sinkAttributes_(attributes), sink_(sink),
          options_(options), work_(options.threads) {
        const auto stored = static_cast<int>(schema().attributes.size());
        for (int attribute : attributes)
            (attribute < stored ? stored_ : derived_).push_back(attribute);
        read_ = stored_;
        for (int attribute : filter.testedAttributes()) {
            auto place = std::find(read_.begin(), read_.end(), attribute);
            testedPlaces_.push_back(static_cast<std::size_t>(place - read_.begin()));
            if (place == read_.end())
                read_.push_back(attribute);
        }
        for (int attribute : stored_)
            sizes_.push_back(schema().attributes[static_cast<std::size_t>(attribute)].size());
        sizes_.resize(attributes.size(), sizeof(double));
    }

    Result<WalkCounters> run() {
        STIPPLE_CHECK(checkDerived());
        auto visited = reader_.visitWanted(
            [&](const NodeEntry& entry) -> Result<bool> {
                STIPPLE_CHECK(askGate(options_.gate, 0));
                STIPPLE_CHECK(visit(entry));
                return filter_.wantsBelow(entry);
            },
            &isEnough_);
        if (!visited)
            return visited.error();
        while (work_.waiting() > 0)
            STIPPLE_CHECK(takeOne());
        if (options_.limit > 0)
            counters_.pointsTaken = std::min(counters_.pointsTaken, options_.limit); // of nodes only counted
        counters_.hierarchy = *visited;
        return counters_;
    }

  private:
    const Schema& schema() const { return reader_.metadata().schema; }

    // Those behind the cloud's own are station and offset, and stand last.
    Status checkDerived() const {
        const auto stored = static_cast<int>(schema().attributes.size());
        bool areLast = std::equal(derived_.rbegin(), derived_.rend(), sinkAttributes_.rbegin());
        bool areKnown = std::all_of(derived_.begin(), derived_.end(), [&](int a) { return a < stored + 2; });
        if (!derived_.empty() && (!areLast || !areKnown || !filter_.hasCorridor()))
            return Error{ErrorCode::invalidArgument, "there are no such attributes", name_, ""};
        return {};
    }

    // Points that are certain to be taken, also from nodes in work.
    void addCertain(std::uint64_t points) {
        certain_ += points;
        isEnough_ = options_.limit > 0 && certain_ >= options_.limit;
    }

    void addTaken(int level, std::uint64_t points) {
        counters_.pointsTaken += points;
        LevelTally& tally = counters_.levels[static_cast<std::size_t>(level)];
        tally.nodes += points > 0;
        tally.points += points;
    }

    Status visit(const NodeEntry& entry) {
        using Verdict = CloudFilter::Verdict;
        Verdict verdict = filter_.verdictOn(entry);
        switch (verdict) {
        case Verdict::outside:
            counters_.outside.add(entry);
            return {};
        case Verdict::finer:
            counters_.finer.add(entry);
            return {};
        case Verdict::absent:
            counters_.absent.add(entry);
            return {};
        case Verdict::whole:
            counters_.whole.add(entry);
            addCertain(entry.pointCount);
            if (!sink_) {
                addTaken(entry.key.level, entry.pointCount);
                return {};
            }
            break;
        case Verdict::tested:
            counters_.tested.add(entry);
            break;
        }
        if (entry.pointCount == 0)
            return {};
        return read(entry, verdict == Verdict::tested ? read_ : stored_, verdict);
    }

    Status read(const NodeEntry& entry, const std::vector<int>& attributes, CloudFilter::Verdict verdict) {
        while (work_.waiting() > 0 &&
               (work_.waiting() >= nodesPerThread * static_cast<std::size_t>(std::max(1, options_.threads)) ||
                pointsWaiting_ + entry.pointCount > maxPointsWaiting))
            STIPPLE_CHECK(takeOne());
        STIPPLE_TRY(fetched, reader_.fetchNode(entry, attributes));
        counters_.bytesRead += fetched.bytes.size();
        counters_.attributeBytesSkipped += entry.sizeBytes() - fetched.bytes.size();
        pointsWaiting_ += entry.pointCount;
        pointsRead_ += entry.pointCount;
        auto node = std::make_shared<NodeBytes>(std::move(fetched));
        bool tested = verdict == CloudFilter::Verdict::tested;
        bool mayBeCut = options_.limit > 0 && pointsRead_ > options_.limit;
        work_.submit([this, node, tested, mayBeCut]() -> Result<Chosen> {
            try {
                return choose(*node, tested, mayBeCut);
            } catch (const std::bad_alloc&) {
                return Error{ErrorCode::outOfMemory, "there is not enough memory to decode it",
                             cat(name_, ", node ", node->entry.key.text()), "use fewer threads"};
            }
        });
        return {};
    }

    // On any thread.
    Result<Chosen> choose(const NodeBytes& node, bool tested, bool mayBeCut) const {
        auto decoded = decodeNode(reader_.metadata(), node, options_.gate);
        if (!decoded)
            return decoded.error().at(name_);
        PointBatch& batch = *decoded;
        if (batch.size() != node.entry.pointCount)
            return Error{ErrorCode::corrupt,
                         cat("node ", node.entry.key.text(), " has ", batch.size(), " points instead of ",
                             node.entry.pointCount),
                         name_, ""};
        Chosen chosen;
        chosen.level = node.entry.key.level;
        chosen.nodePoints = batch.size();
        chosen.tested = tested;
        if (tested) {
            STIPPLE_TRY(kept, test(node.entry, std::move(batch), chosen.dropped));
            batch = std::move(kept);
        }
        chosen.taken = batch.size();
        if (!sink_)
            return chosen;
        if (!derived_.empty()) {
            STIPPLE_TRY(places, filter_.placesAlong(node.entry, batch.positions, options_.gate));
            for (int attribute : derived_)
                batch.columns.push_back(
                    places[static_cast<std::size_t>(attribute) - schema().attributes.size()]);
        }
        if (batch.size() > maxPointsEncoded || mayBeCut) {
            chosen.batch = std::move(batch);
            return chosen;
        }
        auto keep = [&chosen](EncodedPoints encoded) -> Status {
            chosen.encoded.push_back(std::move(encoded));
            return {};
        };
        std::size_t count = batch.size();
        STIPPLE_CHECK(encodeInPieces(*sink_, std::move(batch), count, options_.gate, keep));
        return chosen;
    }

    Result<PointBatch> test(const NodeEntry& entry, PointBatch batch, CloudFilter::Dropped& dropped) const {
        std::vector<const Bytes*> columns;
        for (std::size_t place : testedPlaces_)
            columns.push_back(&batch.columns[place]);
        STIPPLE_TRY(rows, filter_.select(entry, batch.positions, columns, dropped, options_.gate));
        if (rows.size() == batch.size()) {
            batch.columns.resize(stored_.size());
            return batch;
        }
        return pick(batch, rows);
    }

    Result<PointBatch> pick(const PointBatch& batch, std::span<const std::uint32_t> rows) const {
        PointBatch picked;
        picked.positions.reserve(rows.size());
        for (std::size_t i = 0; i < stored_.size(); ++i)
            picked.columns.emplace_back(rows.size() * sizes_[i]);
        STIPPLE_CHECK(inPieces(options_.gate, rows.size(), [&](std::size_t first, std::size_t end) {
            auto piece = rows.subspan(first, end - first);
            for (std::uint32_t row : piece)
                picked.positions.push_back(batch.positions[row]);
            for (std::size_t i = 0; i < stored_.size(); ++i)
                gather(batch.columns[i], piece, sizes_[i], picked.columns[i].data() + first * sizes_[i]);
        }));
        return picked;
    }

    Status takeOne() {
        STIPPLE_CHECK(askGate(options_.gate, 0));
        auto result = work_.take();
        if (!result)
            return result.error();
        Chosen& chosen = *result;
        pointsWaiting_ -= chosen.nodePoints;
        pointsDone_ += chosen.nodePoints;
        if (chosen.tested)
            addCertain(chosen.taken);
        if (sink_ && options_.limit > 0)
            cut(chosen);
        addTaken(chosen.level, chosen.taken);
        counters_.dropped.bySpacing += chosen.dropped.bySpacing;
        counters_.dropped.byRegion += chosen.dropped.byRegion;
        counters_.dropped.byAttribute += chosen.dropped.byAttribute;
        for (EncodedPoints& encoded : chosen.encoded)
            STIPPLE_CHECK(write(std::move(encoded)));
        if (sink_ && chosen.encoded.empty())
            STIPPLE_CHECK(encodeInPieces(*sink_, std::move(chosen.batch),
                                         static_cast<std::size_t>(chosen.taken), options_.gate,
                                         [this](EncodedPoints part) { return write(std::move(part)); }));
        if (options_.progress)
            options_.progress(pointsDone_);
        return {};
    }

    // Leaves no more than the limit does.
    void cut(Chosen& chosen) {
        std::uint64_t left = std::min(chosen.taken, options_.limit - counters_.pointsTaken);
        counters_.droppedByLimit += chosen.taken - left;
        chosen.taken = left;
    }

    Status write(EncodedPoints encoded) {
        STIPPLE_CHECK(askGate(options_.gate, encoded.count));
        return sink_->write(std::move(encoded));
    }

    CloudReader& reader_;
    const std::string& name_;
    const CloudFilter& filter_;
    const std::vector<int>& sinkAttributes_;
    PointSink* sink_; // null: points are counted only
    const WalkOptions& options_;
    std::vector<int> stored_, derived_;     // the sink's attributes: the cloud's own, and those computed
    std::vector<int> read_;                 // those of the cloud, then those only tests need
    std::vector<std::size_t> testedPlaces_; // of the filter's attributes among them
    std::vector<std::size_t> sizes_;        // bytes of the sink's attributes
    WalkCounters counters_;
    std::uint64_t pointsWaiting_ = 0, pointsRead_ = 0, pointsDone_ = 0, certain_ = 0;
    bool isEnough_ = false;            // the limit will be reached
    OrderedWork<Result<Chosen>> work_; // last: its threads end before what they use
};

} // namespace

Result<WalkCounters> walkPoints(CloudReader& reader, const std::string& name, const CloudFilter& filter,
                                const std::vector<int>& attributes, PointSink& sink,
                                const WalkOptions& options) {
    return Walk(reader, name, filter, attributes, &sink, options).run();
}

Result<std::uint64_t> countPoints(CloudReader& reader, const std::string& name, const CloudFilter& filter,
                                  const WalkOptions& options) {
    const std::uint64_t all = reader.metadata().pointCount;
    if (filter.wantsEverything())
        return options.limit > 0 ? std::min(options.limit, all) : all;
    auto counted = Walk(reader, name, filter, {}, nullptr, options).run();
    if (!counted)
        return counted.error();
    return counted->pointsTaken;
}

Result<NodeTally> tallyNodes(CloudReader& reader, const CloudFilter& filter, const WalkOptions& options) {
    NodeTally tally;
    auto visited = reader.visitWanted([&](const NodeEntry& entry) -> Result<bool> {
        STIPPLE_CHECK(askGate(options.gate, 0));
        CloudFilter::Verdict verdict = filter.verdictOn(entry);
        if (verdict == CloudFilter::Verdict::whole || verdict == CloudFilter::Verdict::tested)
            tally.add(entry);
        return filter.wantsBelow(entry);
    });
    if (!visited)
        return visited.error();
    return tally;
}

} // namespace stipple
