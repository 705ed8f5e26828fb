#include "converter/build/node_checks.hpp"

#include "shared/base/text.hpp"
#include "shared/io/file_source.hpp"

#include <algorithm>
#include <cmath>

namespace stipple {

namespace {
constexpr std::size_t keptFaults = 20;
}

void FaultList::add(const std::string& what) {
    std::lock_guard lock(mutex_);
    ++count_;
    if (first_.size() < keptFaults)
        first_.push_back(what);
}

Result<std::unique_ptr<NodeChecks>> NodeChecks::open(const std::string& path, int workers,
                                                     FaultList& faults) {
    std::unique_ptr<NodeChecks> checks(new NodeChecks(faults));
    checks->workers_.resize(static_cast<std::size_t>(workers));
    for (Worker& worker : checks->workers_) {
        STIPPLE_TRY(source, openFileSource(path));
        worker.source = std::move(source);
        auto reader = CloudReader::open(*worker.source);
        if (!reader)
            return reader.error().where.find(path) == std::string::npos ? reader.error().at(path)
                                                                        : reader.error();
        worker.reader = std::move(reader).value();
        worker.statistics = emptyStatistics(worker.reader->metadata().schema);
    }
    return checks;
}

std::vector<NodeEntry> NodeChecks::listNodes() {
    std::vector<NodeEntry> entries;
    Status listed = workers_[0].reader->visitNodes([&](const NodeEntry& entry) -> Status {
        entries.push_back(entry);
        return {};
    });
    if (!listed) {
        faults_.add(listed.error().sentence());
        entries.clear();
    }
    return entries;
}

const PointBatch* NodeChecks::check(const NodeEntry& entry, int number) {
    Worker& worker = workers_[static_cast<std::size_t>(number)];
    auto read = worker.reader->readNode(entry);
    if (!read) {
        faults_.add(read.error().sentence());
        return nullptr;
    }
    worker.batch = std::move(read).value();
    if (worker.batch.size() != entry.pointCount) {
        faults_.add(cat("node ", entry.key.text(), ": ", worker.batch.size(),
                        " points were decoded, but the hierarchy says ", entry.pointCount));
        return nullptr;
    }
    checkPositions(entry, worker);
    if (entry.childMask != 0 && metadata().spacing > 0 && metadata().sampling == Sampling::poisson)
        checkSpacing(entry, worker);
    worker.hash.add(metadata().schema, worker.batch);
    merge(worker.statistics, statisticsOf(metadata().schema, worker.batch));
    worker.sums.points += worker.batch.size();
    return &worker.batch;
}

void NodeChecks::checkPositions(const NodeEntry& entry, Worker& worker) {
    int bits = metadata().rootCube.nodeBits(entry.key.level);
    Vec3i corner = metadata().rootCube.nodeMin(entry.key);
    std::size_t outside = 0;
    for (Vec3i p : worker.batch.positions) {
        worker.bounds.extend(p);
        Vec3i in = p - corner;
        bool inside = in.x >= 0 && in.y >= 0 && in.z >= 0 && in.x >> bits == 0 && in.y >> bits == 0 &&
                      in.z >> bits == 0;
        outside += inside ? 0 : 1;
    }
    if (outside > 0)
        faults_.add(cat("node ", entry.key.text(), ": ", outside, " of its points lie outside of it"));
}

// The distance in world units, whatever the sampler's own measure was.
void NodeChecks::checkSpacing(const NodeEntry& entry, Worker& worker) {
    constexpr double rounding = 1 - 1e-9;
    const Vec3d& scale = metadata().grid.scale;
    const double spacing = std::ldexp(metadata().spacing, -entry.key.level);
    double unit = std::max(scale.x, scale.y);
    double distance = spacing / unit * rounding;
    worker.sampler.begin(metadata().rootCube.nodeBits(entry.key.level),
                         {scale.x / unit, scale.y / unit, scale.z / unit}, distance * distance);
    Vec3i corner = metadata().rootCube.nodeMin(entry.key);
    std::uint64_t tooNear = 0;
    for (Vec3i p : worker.batch.positions)
        tooNear += worker.sampler.accept(p - corner) ? 0 : 1;
    worker.sums.spacedPoints += worker.batch.size();
    worker.sums.tooNear += tooNear;
    if (tooNear > 0)
        faults_.add(cat("node ", entry.key.text(), ": ", tooNear,
                        " of its points are nearer to another than ", spacing));
}

NodeChecks::Sums NodeChecks::checkWhole() {
    BatchStatistics statistics = emptyStatistics(metadata().schema);
    PointHash hash;
    BoxI bounds;
    Sums sums;
    for (const Worker& worker : workers_) {
        sums.points += worker.sums.points;
        sums.spacedPoints += worker.sums.spacedPoints;
        sums.tooNear += worker.sums.tooNear;
        hash.add(worker.hash);
        bounds.extend(worker.bounds);
        merge(statistics, worker.statistics);
    }
    if (sums.points != metadata().pointCount)
        faults_.add(
            cat("the nodes hold ", sums.points, " points, but the metadata say ", metadata().pointCount));
    if (hash.hex() != metadata().pointHash)
        faults_.add(
            cat("the hash of the points is ", hash.hex(), ", but the metadata say ", metadata().pointHash));
    if (sums.points > 0 && bounds != metadata().bounds)
        faults_.add("the bounds in the metadata are not those of the points");
    checkStatistics(statistics);
    return sums;
}

// Means and deviations depend on the order of summing; the rest is exact.
void NodeChecks::checkStatistics(const BatchStatistics& found) {
    if (metadata().statistics.size() != found.size())
        return faults_.add("the metadata lack statistics of some attributes");
    for (std::size_t a = 0; a < found.size(); ++a) {
        AttributeStatistics real = found[a].finish();
        const AttributeStatistics& stated = metadata().statistics[a];
        if (real.min != stated.min || real.max != stated.max || real.histogram != stated.histogram)
            faults_.add(cat("the statistics of ", metadata().schema.attributes[a].name,
                            " in the metadata are not those of the points"));
    }
}

} // namespace stipple
