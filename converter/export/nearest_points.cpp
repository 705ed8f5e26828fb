#include "converter/export/nearest_points.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <set>
#include <unordered_map>

namespace stipple {

namespace {

Vec3d clampedTo(const BoxD& box, Vec3d p) {
    for (int axis = 0; axis < 3; ++axis)
        p[axis] = std::clamp(p[axis], box.min[axis], box.max[axis]);
    return p;
}

double distanceOf(Vec3d from, Vec3d to, bool inPlan) {
    Vec3d apart = to - from;
    double flat = apart.x * apart.x + apart.y * apart.y;
    return std::sqrt(inPlan ? flat : flat + apart.z * apart.z);
}

} // namespace

std::optional<double> DistanceRank::rankOf(Vec3d world) const {
    double distance = distanceOf(place_, world, inPlan_);
    return distance <= most_ ? std::optional(distance) : std::nullopt;
}

std::optional<double> DistanceRank::bestOf(const BoxD& box) const {
    return rankOf(clampedTo(box, place_));
}

double RayRank::alongOf(Vec3d world) const {
    Vec3d from = world - origin_;
    return (from.x * direction_.x + from.y * direction_.y) + from.z * direction_.z;
}

double RayRank::distanceFromRay(Vec3d world) const {
    return length(cross(world - origin_, direction_));
}

std::optional<double> RayRank::rankOf(Vec3d world) const {
    double along = alongOf(world);
    bool counts = along >= 0 && along <= most_ && distanceFromRay(world) <= radius_ + slope_ * along;
    return counts ? std::optional(along) : std::nullopt;
}

std::optional<double> RayRank::bestOf(const BoxD& box) const {
    Vec3d first, last; // the corners that lie least and furthest along
    for (int axis = 0; axis < 3; ++axis) {
        first[axis] = direction_[axis] >= 0 ? box.min[axis] : box.max[axis];
        last[axis] = direction_[axis] >= 0 ? box.max[axis] : box.min[axis];
    }
    double nearest = std::max(0.0, alongOf(first)), furthest = alongOf(last);
    if (furthest < 0 || nearest > most_ || !mayMeet(box, std::min(furthest, most_)))
        return std::nullopt;
    return nearest;
}

// Does the ray meet the box, widened by how far from it points may be? (Slabs; a little wider still, for
// rounding.)
bool RayRank::mayMeet(const BoxD& box, double furthest) const {
    double around = radius_ + slope_ * furthest;
    double begin = -around, end = furthest + around;
    for (int axis = 0; axis < 3; ++axis) {
        double low = box.min[axis] - origin_[axis], high = box.max[axis] - origin_[axis];
        double margin = around + 0x1p-40 * (around + std::abs(low) + std::abs(high));
        low -= margin;
        high += margin;
        double step = direction_[axis];
        if (step == 0) {
            if (low > 0 || high < 0)
                return false;
            continue;
        }
        begin = std::max(begin, std::min(low / step, high / step));
        end = std::min(end, std::max(low / step, high / step));
    }
    double rounding = 0x1p-40 * (std::abs(begin) + std::abs(end));
    return begin <= end + rounding;
}

namespace {

struct Waiting {
    double best = 0;
    NodeEntry node;
    // Of a priority queue: the best comes out first.
    friend bool operator<(const Waiting& a, const Waiting& b) {
        return a.best != b.best ? a.best > b.best : b.node.key < a.node.key;
    }
};

class Search {
  public:
    Search(CloudReader& reader, const std::string& name, const CloudFilter& filter, const PointRank& rank,
           std::size_t count, const WorkGate* gate)
        : reader_(reader), name_(name), filter_(filter), rank_(rank), count_(count), gate_(gate) {}

    Result<NearestPoints> run() {
        STIPPLE_CHECK(readChunk(rootChunkPlace(reader_.header())));
        enqueue(NodeKey{});
        while (!queue_.empty()) {
            STIPPLE_CHECK(askGate(gate_, 0));
            Waiting next = queue_.top();
            queue_.pop();
            if (best_.size() == count_ && next.best > best_.rbegin()->rank)
                break;
            STIPPLE_CHECK(rankPointsOf(next.node));
            STIPPLE_CHECK(enqueueBelow(next.node));
        }
        return NearestPoints{{best_.begin(), best_.end()}, counters_};
    }

  private:
    Status readChunk(const ChunkPlace& place) {
        STIPPLE_TRY(nodes, reader_.readChunk(place));
        ++counters_.chunksRead;
        for (NodeEntry& node : nodes)
            known_.insert_or_assign(node.key, std::move(node));
        return {};
    }

    void enqueue(const NodeKey& key) {
        auto found = known_.find(key);
        if (found == known_.end())
            return;
        const NodeEntry& node = found->second;
        BoxI points = filter_.boxOfWanted(node);
        if (!points.empty())
            if (auto best = rank_.bestOf({reader_.metadata().grid.toWorld(points.min),
                                          reader_.metadata().grid.toWorld(points.max)}))
                queue_.push({*best, node});
        known_.erase(found);
    }

    Status enqueueBelow(const NodeEntry& node) {
        if (node.childMask == 0 || !filter_.wantsBelow(node))
            return {};
        if (node.childChunk.size > 0)
            STIPPLE_CHECK(readChunk(childChunkPlace(node)));
        for (int child = 0; child < 8; ++child)
            if ((node.childMask >> child) & 1)
                enqueue(node.key.child(child));
        return {};
    }

    Status rankPointsOf(const NodeEntry& node) {
        using Verdict = CloudFilter::Verdict;
        Verdict verdict = filter_.verdictOn(node);
        if (node.pointCount == 0 || (verdict != Verdict::whole && verdict != Verdict::tested))
            return {};
        STIPPLE_TRY(points, readNode(node));
        std::vector<const Bytes*> tested;
        for (const Bytes& column : points.columns)
            tested.push_back(&column);
        CloudFilter::Dropped dropped;
        std::vector<std::uint32_t> rows;
        if (verdict == Verdict::tested) {
            STIPPLE_TRY(kept, filter_.select(node, points.positions, tested, dropped, gate_));
            rows = std::move(kept);
        } else {
            rows.resize(points.size());
            std::iota(rows.begin(), rows.end(), 0u);
        }
        counters_.pointsRanked += rows.size();
        return inPieces(gate_, rows.size(), [&](std::size_t first, std::size_t end) {
            for (std::size_t i = first; i < end; ++i)
                consider(node, rows[i], points.positions[rows[i]]);
        });
    }

    void consider(const NodeEntry& node, std::uint32_t row, Vec3i position) {
        auto rank = rank_.rankOf(reader_.metadata().grid.toWorld(position));
        if (!rank || (best_.size() == count_ && *rank > best_.rbegin()->rank))
            return;
        best_.insert({*rank, node, row, position});
        if (best_.size() > count_)
            best_.erase(std::prev(best_.end()));
    }

    Result<PointBatch> readNode(const NodeEntry& node) {
        STIPPLE_TRY(bytes, reader_.fetchNode(node, filter_.testedAttributes()));
        ++counters_.nodesRead;
        counters_.bytesRead += bytes.bytes.size();
        auto points = decodeNode(reader_.metadata(), bytes, gate_);
        if (!points)
            return points.error().at(name_);
        return points;
    }

    CloudReader& reader_;
    const std::string& name_;
    const CloudFilter& filter_;
    const PointRank& rank_;
    const std::size_t count_;
    const WorkGate* gate_;
    std::unordered_map<NodeKey, NodeEntry, NodeKeyHash> known_; // met in a chunk, not looked at yet
    std::priority_queue<Waiting> queue_;
    std::set<RankedPoint> best_;
    NearestCounters counters_;
};

} // namespace

Result<NearestPoints> nearestPoints(CloudReader& reader, const std::string& name, const CloudFilter& filter,
                                    const PointRank& rank, std::size_t count, const WorkGate* gate) {
    return Search(reader, name, filter, rank, count, gate).run();
}

} // namespace stipple
