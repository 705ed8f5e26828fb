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

// The largest value of a column of uint16, and the smallest.
void extremes(const Schema& schema, const PointBatch& batch, std::string_view name, std::uint16_t& min,
              std::uint16_t& max) {
    int a = schema.find(name);
    if (a < 0)
        return;
    const Attribute& attribute = schema.attributes[static_cast<std::size_t>(a)];
    if (attribute.type != AttributeType::u16 || attribute.components != 1)
        return;
    for (std::size_t i = 0; i < batch.size(); ++i) {
        std::uint16_t value = batch.value<std::uint16_t>(a, i);
        min = std::min(min, value);
        max = std::max(max, value);
    }
}

ColourExtremes colourExtremes(const Schema& schema, const PointBatch& batch) {
    using namespace attribute_names;
    ColourExtremes result;
    std::uint16_t unused = 0;
    extremes(schema, batch, red, unused, result.rgbMax[0]);
    extremes(schema, batch, green, unused, result.rgbMax[1]);
    extremes(schema, batch, blue, unused, result.rgbMax[2]);
    extremes(schema, batch, intensity, result.intensityMin, result.intensityMax);
    return result;
}

// What one thread works with and has summed so far.
struct Worker {
    PointBatch raw, mapped;
    std::vector<BoxI> inputBounds; // in each input's own integers
    BoxI bounds;
    PointHash hash;
    ColourExtremes colour;
    double gridError = 0;
    ReadReport report;
};

bool isIdentity(const Scan& scan, const ScannedInput& input) {
    if (!input.toCloud.isIdentity() ||
        input.description().schema.attributes.size() != scan.schema.attributes.size())
        return false;
    for (std::size_t a = 0; a < input.attributeSources.size(); ++a)
        if (input.attributeSources[a] != static_cast<int>(a))
            return false;
    return true;
}

// `worker.raw` as points of the cloud.
void mapBatch(const Scan& scan, const ScannedInput& input, Worker& worker) {
    PointBatch& mapped = worker.mapped;
    mapped.resize(scan.schema, worker.raw.size());
    for (std::size_t i = 0; i < mapped.size(); ++i) {
        Vec3i p = worker.raw.positions[i];
        mapped.positions[i] = input.toCloud.toCloud(p);
        if (!input.toCloud.isExact())
            for (int axis = 0; axis < 3; ++axis)
                worker.gridError =
                    std::max(worker.gridError,
                             scan.grid.scale[axis] *
                                 input.toCloud.axes[static_cast<std::size_t>(axis)].errorSteps(p[axis]));
    }
    for (std::size_t a = 0; a < input.attributeSources.size(); ++a) {
        int from = input.attributeSources[a];
        if (from < 0)
            std::fill(mapped.columns[a].begin(), mapped.columns[a].end(), std::uint8_t{0});
        else
            mapped.columns[a] = worker.raw.columns[static_cast<std::size_t>(from)];
    }
}

Status takeBatch(const Scan& scan, std::size_t index, Worker& worker, PointStore& store, std::uint64_t row) {
    const ScannedInput& input = scan.inputs[index];
    BoxI& own = worker.inputBounds[index];
    for (Vec3i p : worker.raw.positions)
        own.extend(p);
    bool same = isIdentity(scan, input);
    if (!same)
        mapBatch(scan, input, worker);
    const PointBatch& batch = same ? worker.raw : worker.mapped;
    for (Vec3i p : batch.positions)
        worker.bounds.extend(p);
    worker.hash.add(scan.schema, batch);
    worker.colour.extend(colourExtremes(scan.schema, batch));
    store.put(static_cast<std::size_t>(row), batch);
    return {};
}

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
        STIPPLE_CHECK(takeBatch(scan, read.input, worker, store, row));
        row += worker.raw.size();
    }
    worker.report.add(stream->report());
    if (row != end)
        return Error{ErrorCode::changed,
                     cat(end - row, " points fewer came than were counted when it was opened"),
                     input.description().path, "convert again when the file is complete"};
    return {};
}

} // namespace

void ColourExtremes::extend(const ColourExtremes& other) {
    for (std::size_t i = 0; i < 3; ++i)
        rgbMax[i] = std::max(rgbMax[i], other.rgbMax[i]);
    intensityMin = std::min(intensityMin, other.intensityMin);
    intensityMax = std::max(intensityMax, other.intensityMax);
}

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
        worker.inputBounds.resize(scan.inputs.size());
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
    std::vector<BoxI> inputBounds(scan.inputs.size());
    for (const Worker& worker : workers) {
        loaded.bounds.extend(worker.bounds);
        loaded.hash.add(worker.hash);
        loaded.colour.extend(worker.colour);
        loaded.maxGridError = std::max(loaded.maxGridError, worker.gridError);
        for (std::size_t i = 0; i < inputBounds.size(); ++i)
            inputBounds[i].extend(worker.inputBounds[i]);
    }
    for (std::size_t i = 0; i < inputBounds.size(); ++i)
        if (auto lie = scan.inputs[i].input->contradiction(inputBounds[i]))
            loaded.warnings.push_back(
                cat(scan.inputs[i].description().path, ": ", *lie, "; the points' bounds are used"));
    if (loaded.maxGridError > 0)
        loaded.warnings.push_back(cat("the inputs' grids have no common one; points moved by at most ",
                                      loaded.maxGridError, " to fit the finest"));
    return loaded;
}

} // namespace stipple
