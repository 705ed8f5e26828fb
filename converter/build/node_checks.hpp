// Whether the nodes of a `.stipple` file are what they and the metadata say: every block's checksum, every
// node decodes, counts agree, points lie in their node and in the bounds, inner nodes keep their minimum
// distance, statistics and hash are those of the metadata.
#pragma once

#include "converter/build/disk_sampler.hpp"
#include "converter/build/statistics.hpp"
#include "shared/base/result.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/format/point_hash.hpp"
#include "shared/geometry/box.hpp"

#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace stipple {

// What is wrong, one sentence each: counted, the first of them kept. Thread: any.
class FaultList {
  public:
    void add(const std::string& what);
    std::uint64_t count() const { return count_; }
    const std::vector<std::string>& first() const { return first_; }

  private:
    std::mutex mutex_;
    std::uint64_t count_ = 0;
    std::vector<std::string> first_;
};

class NodeChecks {
  public:
    // Opens the file once for each worker. Errors: no such file, no Stipple file.
    static Result<std::unique_ptr<NodeChecks>> open(const std::string& path, int workers, FaultList& faults);

    const CloudMetadata& metadata() const { return workers_[0].reader->metadata(); }
    std::uint64_t fileBytes() const { return workers_[0].reader->header().fileBytes; }
    // The whole hierarchy. Where a part of it can't be read that is a fault, and nothing is returned.
    std::vector<NodeEntry> listNodes();

    // Reads and checks a node. Its points stay until the worker's next call; null if they can't be read,
    // which is a fault then. Thread: one a worker (of [0, workers)). Each node once.
    const PointBatch* check(const NodeEntry& entry, int worker);

    struct Sums {
        std::uint64_t points = 0;
        std::uint64_t spacedPoints = 0; // of inner nodes, whose minimum distance was measured (poisson)
        std::uint64_t tooNear = 0;      // of these: nearer to one of their node than its spacing
    };
    // Once every node was checked: what they are together.
    Sums checkWhole();

  private:
    // One thread's own way into the file, and what it found.
    struct Worker {
        std::unique_ptr<ByteSource> source;
        std::unique_ptr<CloudReader> reader;
        PointBatch batch;
        DiskSampler sampler;
        BatchStatistics statistics;
        PointHash hash;
        BoxI bounds;
        Sums sums;
    };

    explicit NodeChecks(FaultList& faults) : faults_(faults) {}
    void checkPositions(const NodeEntry& entry, Worker& worker);
    void checkSpacing(const NodeEntry& entry, Worker& worker);
    void checkStatistics(const BatchStatistics& found);

    FaultList& faults_;
    std::vector<Worker> workers_;
};

} // namespace stipple
