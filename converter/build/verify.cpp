#include "converter/build/verify.hpp"

#include "converter/build/disk_sampler.hpp"
#include "converter/build/parallel.hpp"
#include "converter/build/read_points.hpp"
#include "converter/build/statistics.hpp"
#include "shared/base/text.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/file_source.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <new>

namespace stipple {

namespace {
constexpr std::size_t maxFaults = 20;

// One thread's own way into the file, and what it found.
struct Worker {
    std::unique_ptr<ByteSource> source;
    std::unique_ptr<CloudReader> reader;
    DiskSampler sampler;
    BatchStatistics statistics;
    PointHash hash;
    BoxI bounds;
    std::uint64_t points = 0, spacedPoints = 0, tooNear = 0;
};

class Verification {
  public:
    Verification(const std::string& path, const InputOptions& reading, const std::atomic<bool>* stop,
                 const ConvertProgress& progress)
        : path_(path), reading_(reading), stop_(stop), progress_(progress) {}

    Result<VerifyReport> run(const std::vector<std::string>& inputs, int threads) {
        STIPPLE_CHECK(open(threads));
        const CloudMetadata metadata = workers_[0].reader->metadata();
        for (const Attribute& attribute : metadata.schema.attributes)
            report_.attributeNames.push_back(attribute.name);
        report_.fileBytes = workers_[0].reader->header().fileBytes;
        if (!listNodes())
            return std::move(report_);
        PointStore store;
        if (!inputs.empty())
            store = PointStore(metadata.schema, firstRows_.back());
        auto check = [&](std::size_t i, int worker) {
            return checkNode(entries_[i], firstRows_[i], inputs.empty() ? nullptr : &store,
                             workers_[static_cast<std::size_t>(worker)]);
        };
        STIPPLE_CHECK(parallelFor(entries_.size(), threads, stop_, check));
        checkWhole(metadata);
        // Rows of nodes that could not be read were never filled, so there is nothing to compare.
        if (!inputs.empty() && report_.points == firstRows_.back())
            STIPPLE_CHECK(compareWithInputs(inputs, metadata, store, threads));
        return std::move(report_);
    }

  private:
    Status open(int threads) {
        workers_.resize(static_cast<std::size_t>(threads));
        for (Worker& worker : workers_) {
            STIPPLE_TRY(source, openFileSource(path_));
            worker.source = std::move(source);
            auto reader = CloudReader::open(*worker.source);
            if (!reader)
                return reader.error().where.find(path_) == std::string::npos ? reader.error().at(path_)
                                                                             : reader.error();
            worker.reader = std::move(reader).value();
            worker.statistics = emptyStatistics(worker.reader->metadata().schema);
        }
        return {};
    }

    void fault(const std::string& what) {
        std::lock_guard lock(mutex_);
        ++report_.faultCount;
        if (report_.faults.size() < maxFaults)
            report_.faults.push_back(what);
    }

    bool listNodes() {
        std::uint64_t points = 0;
        Status listed = workers_[0].reader->visitNodes([&](const NodeEntry& entry) -> Status {
            firstRows_.push_back(points);
            points += entry.pointCount;
            entries_.push_back(entry);
            return {};
        });
        firstRows_.push_back(points);
        report_.nodes = entries_.size();
        if (!listed)
            fault(listed.error().sentence());
        return listed.ok();
    }

    Status checkNode(const NodeEntry& entry, std::uint64_t firstRow, PointStore* store, Worker& worker) {
        const CloudMetadata& metadata = worker.reader->metadata();
        auto read = worker.reader->readNode(entry);
        if (!read) {
            fault(read.error().sentence());
            return {};
        }
        const PointBatch& batch = *read;
        if (batch.size() != entry.pointCount) {
            fault(cat("node ", entry.key.text(), ": ", batch.size(),
                      " points were decoded, but the hierarchy says ", entry.pointCount));
            return {};
        }
        checkPositions(metadata, entry, batch, worker);
        if (entry.childMask != 0 && metadata.spacing > 0 && metadata.sampling == Sampling::poisson)
            checkSpacing(metadata, entry, batch, worker);
        worker.hash.add(metadata.schema, batch);
        merge(worker.statistics, statisticsOf(metadata.schema, batch));
        worker.points += batch.size();
        if (store)
            store->put(static_cast<std::size_t>(firstRow), batch);
        std::lock_guard lock(mutex_);
        done_ += batch.size();
        progress_("verify", done_, metadata.pointCount);
        return {};
    }

    void checkPositions(const CloudMetadata& metadata, const NodeEntry& entry, const PointBatch& batch,
                        Worker& worker) {
        int bits = metadata.rootCube.nodeBits(entry.key.level);
        Vec3i corner = metadata.rootCube.nodeMin(entry.key);
        std::size_t outside = 0;
        for (Vec3i p : batch.positions) {
            worker.bounds.extend(p);
            Vec3i in = p - corner;
            bool inside = in.x >= 0 && in.y >= 0 && in.z >= 0 && in.x >> bits == 0 && in.y >> bits == 0 &&
                          in.z >> bits == 0;
            outside += inside ? 0 : 1;
        }
        if (outside > 0)
            fault(cat("node ", entry.key.text(), ": ", outside, " of its points lie outside of it"));
    }

    // The distance in world units, whatever the sampler's own measure was.
    void checkSpacing(const CloudMetadata& metadata, const NodeEntry& entry, const PointBatch& batch,
                      Worker& worker) {
        constexpr double rounding = 1 - 1e-9;
        const Vec3d& scale = metadata.grid.scale;
        double unit = std::max(scale.x, scale.y);
        double distance = std::ldexp(metadata.spacing, -entry.key.level) / unit * rounding;
        worker.sampler.begin(metadata.rootCube.nodeBits(entry.key.level),
                             {scale.x / unit, scale.y / unit, scale.z / unit}, distance * distance);
        Vec3i corner = metadata.rootCube.nodeMin(entry.key);
        std::uint64_t tooNear = 0;
        for (Vec3i p : batch.positions)
            tooNear += worker.sampler.accept(p - corner) ? 0 : 1;
        worker.spacedPoints += batch.size();
        worker.tooNear += tooNear;
        if (tooNear > 0)
            fault(cat("node ", entry.key.text(), ": ", tooNear, " of its points are nearer to another than ",
                      std::ldexp(metadata.spacing, -entry.key.level)));
    }

    void checkWhole(const CloudMetadata& metadata) {
        BatchStatistics statistics = emptyStatistics(metadata.schema);
        PointHash hash;
        BoxI bounds;
        for (const Worker& worker : workers_) {
            report_.points += worker.points;
            report_.spacedPoints += worker.spacedPoints;
            report_.tooNear += worker.tooNear;
            hash.add(worker.hash);
            bounds.extend(worker.bounds);
            merge(statistics, worker.statistics);
        }
        if (report_.points != metadata.pointCount)
            fault(cat("the nodes hold ", report_.points, " points, but the metadata say ",
                      metadata.pointCount));
        if (hash.hex() != metadata.pointHash)
            fault(
                cat("the hash of the points is ", hash.hex(), ", but the metadata say ", metadata.pointHash));
        if (report_.points > 0 && bounds != metadata.bounds)
            fault("the bounds in the metadata are not those of the points");
        checkStatistics(metadata, statistics);
    }

    // Means and deviations depend on the order of summing; the rest is exact.
    void checkStatistics(const CloudMetadata& metadata, const BatchStatistics& found) {
        if (metadata.statistics.size() != found.size())
            return fault("the metadata lack statistics of some attributes");
        for (std::size_t a = 0; a < found.size(); ++a) {
            AttributeStatistics real = found[a].finish();
            const AttributeStatistics& stated = metadata.statistics[a];
            if (real.min != stated.min || real.max != stated.max || real.histogram != stated.histogram)
                fault(cat("the statistics of ", metadata.schema.attributes[a].name,
                          " in the metadata are not those of the points"));
        }
    }

    Status compareWithInputs(const std::vector<std::string>& inputs, const CloudMetadata& metadata,
                             const PointStore& store, int threads) {
        ScanOptions options;
        options.input = reading_;
        if (metadata.crs.known())
            options.target = metadata.crs; // as they were reprojected for the file
        STIPPLE_TRY(scan, scanInputs(inputs, options));
        for (const std::string& name : mapOnto(scan, metadata.grid, metadata.schema))
            fault(cat("the inputs' attribute ", name, " is missing or of another type in the file"));
        STIPPLE_TRY(loaded, readPoints(scan, threads, stop_, progress_));
        if (loaded.sums.maxGridError > 0)
            report_.warnings.push_back(
                cat("compared on the file's grid, which holds the inputs' positions to within ",
                    loaded.sums.maxGridError));
        STIPPLE_TRY(comparison,
                    comparePoints(store, loaded.store, metadata.grid, metadata.schema, threads, stop_));
        report_.comparison = std::move(comparison);
        return {};
    }

    const std::string& path_;
    const InputOptions& reading_;
    const std::atomic<bool>* stop_;
    const ConvertProgress& progress_;
    std::vector<Worker> workers_;
    std::vector<NodeEntry> entries_;
    std::vector<std::uint64_t> firstRows_; // of each node in the store, then the end
    VerifyReport report_;
    std::mutex mutex_;
    std::uint64_t done_ = 0;
};
} // namespace

Result<VerifyReport> verifyFile(const std::string& path, const std::vector<std::string>& inputs, int threads,
                                const std::atomic<bool>* stop, const ConvertProgress& progress,
                                const InputOptions& reading) {
    try {
        return Verification(path, reading, stop, progress).run(inputs, threadCount(threads));
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::limitExceeded, "there is not enough memory to compare all points", path, ""};
    }
}

} // namespace stipple
