#include "converter/build/read_points.hpp"

#include "converter/build/parallel.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <mutex>
#include <new>

namespace stipple {

namespace {
constexpr std::uint64_t maxPoints = 0xFFFFFFFFu; // indices in memory are 32-bit

// One part of one input.
struct Read {
    std::size_t input = 0, part = 0;
    std::uint64_t row = 0; // of its first point, in the store
};

std::vector<Read> readsOf(const Scan& scan) {
    std::vector<Read> result;
    std::uint64_t row = 0;
    for (std::size_t i = 0; i < scan.inputs.size(); ++i) {
        const std::vector<InputPart>& parts = scan.inputs[i].input->parts();
        for (std::size_t p = 0; p < parts.size(); ++p) {
            result.push_back({i, p, row});
            row += parts[p].points;
        }
    }
    return result;
}

// What one thread works with and has summed so far.
struct Worker {
    PointBatch raw, mapped;
    PointSums sums;
};

Status readPart(const Scan& scan, const Read& read, Worker& worker, PointStore& store) {
    const PointInput& input = *scan.inputs[read.input].input;
    STIPPLE_TRY(stream, input.openPart(read.part));
    std::uint64_t row = read.row, end = row + input.parts()[read.part].points;
    for (;;) {
        STIPPLE_CHECK(stream->next(worker.raw));
        if (worker.raw.size() == 0)
            break;
        if (worker.raw.size() > end - row)
            return Error{ErrorCode::changed, "more points came than were counted when it was opened",
                         input.description().path, "convert again when the file is complete"};
        const PointBatch& batch = toCloud(scan, read.input, worker.raw, worker.mapped, worker.sums);
        worker.sums.hash.add(scan.schema, batch);
        store.put(static_cast<std::size_t>(row), batch);
        row += worker.raw.size();
    }
    worker.sums.report.add(stream->report());
    if (row != end)
        return Error{ErrorCode::changed,
                     cat(end - row, " points fewer came than were counted when it was opened"),
                     input.description().path, "convert again when the file is complete"};
    return {};
}

} // namespace

Result<LoadedPoints> readPoints(const Scan& scan, int threads, const std::atomic<bool>* stop,
                                const ConvertProgress& progress) {
    LoadedPoints loaded;
    if (scan.pointCount > maxPoints)
        return Error{
            ErrorCode::limitExceeded,
            cat("the inputs hold ", scan.pointCount, " points, but this version takes at most ", maxPoints),
            "", "convert fewer of them at once"};
    try {
        loaded.store = PointStore(scan.schema, scan.pointCount);
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::limitExceeded,
                     cat("there is not enough memory for ", scan.pointCount, " points"), "",
                     "convert fewer of them at once"};
    }
    std::vector<Worker> workers(static_cast<std::size_t>(threads));
    for (Worker& worker : workers)
        worker.sums = PointSums(scan.inputs.size());
    std::vector<Read> reads = readsOf(scan);
    std::mutex progressMutex;
    std::uint64_t done = 0;
    auto readOne = [&](std::size_t index, int worker) -> Status {
        const Read& read = reads[index];
        STIPPLE_CHECK(readPart(scan, read, workers[static_cast<std::size_t>(worker)], loaded.store));
        std::lock_guard lock(progressMutex);
        done += scan.inputs[read.input].input->parts()[read.part].points;
        progress("tile", done, scan.pointCount);
        return {};
    };
    STIPPLE_CHECK(parallelFor(reads.size(), threads, stop, readOne));
    loaded.sums = PointSums(scan.inputs.size());
    for (const Worker& worker : workers)
        loaded.sums.add(worker.sums);
    return loaded;
}

} // namespace stipple
