#include "converter/export/walk_points.hpp"

#include "converter/export/ordered_work.hpp"
#include "shared/base/text.hpp"
#include "shared/select/point_chooser.hpp"
#include "shared/sinks/encode_pieces.hpp"

#include <algorithm>
#include <memory>
#include <new>

namespace stipple {

namespace {

constexpr std::size_t nodesPerThread = 4;
constexpr std::uint64_t maxPointsWaiting = 2'000'000;
constexpr std::size_t maxPointsEncoded = 1 << 18; // ahead of writing: text takes many times what points do

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
    Walk(CloudReader& reader, const std::string& name, const CloudFilter& filter, PointChooser chooser,
         PointSink* sink, const WalkOptions& options)
        : reader_(reader), name_(name), filter_(filter), chooser_(std::move(chooser)), sink_(sink),
          options_(options), work_(options.threads) {}

    Result<WalkCounters> run() {
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
        return read(entry, verdict == Verdict::tested);
    }

    Status read(const NodeEntry& entry, bool tested) {
        while (work_.waiting() > 0 &&
               (work_.waiting() >= nodesPerThread * static_cast<std::size_t>(std::max(1, options_.threads)) ||
                pointsWaiting_ + entry.pointCount > maxPointsWaiting))
            STIPPLE_CHECK(takeOne());
        STIPPLE_TRY(fetched, reader_.fetchNode(entry, chooser_.attributesToRead(tested)));
        counters_.bytesRead += fetched.bytes.size();
        counters_.attributeBytesSkipped += entry.sizeBytes() - fetched.bytes.size();
        pointsWaiting_ += entry.pointCount;
        pointsRead_ += entry.pointCount;
        auto node = std::make_shared<NodeBytes>(std::move(fetched));
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
        Chosen chosen;
        auto wanted = chooser_.choose(node, tested, chosen.dropped, options_.gate);
        if (!wanted)
            return wanted.error().at(name_);
        PointBatch& batch = *wanted;
        chosen.level = node.entry.key.level;
        chosen.nodePoints = node.entry.pointCount;
        chosen.tested = tested;
        chosen.taken = batch.size();
        if (!sink_)
            return chosen;
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
    const PointChooser chooser_;
    PointSink* sink_; // null: points are counted only
    const WalkOptions& options_;
    WalkCounters counters_;
    std::uint64_t pointsWaiting_ = 0, pointsRead_ = 0, pointsDone_ = 0, certain_ = 0;
    bool isEnough_ = false;            // the limit will be reached
    OrderedWork<Result<Chosen>> work_; // last: its threads end before what they use
};

} // namespace

Result<WalkCounters> walkPoints(CloudReader& reader, const std::string& name, const CloudFilter& filter,
                                const std::vector<int>& attributes, PointSink& sink,
                                const WalkOptions& options) {
    auto chooser = PointChooser::make(reader.metadata(), filter, attributes);
    if (!chooser)
        return chooser.error().at(name);
    return Walk(reader, name, filter, std::move(*chooser), &sink, options).run();
}

Result<std::uint64_t> countPoints(CloudReader& reader, const std::string& name, const CloudFilter& filter,
                                  const WalkOptions& options) {
    const std::uint64_t all = reader.metadata().pointCount;
    if (filter.wantsEverything())
        return options.limit > 0 ? std::min(options.limit, all) : all;
    STIPPLE_TRY(chooser, PointChooser::make(reader.metadata(), filter, {}));
    auto counted = Walk(reader, name, filter, std::move(chooser), nullptr, options).run();
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
