#include "client/reference/render_cloud.hpp"

#include "client/reference/finest_nodes.hpp"
#include "client/reference/leaf_densities.hpp"
#include "client/reference/node_reader.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

namespace stipple::reference {
namespace {

// A picture being drawn.
struct Easel {
    explicit Easel(const Job& of) : job(of), canvas(of.view.width, of.view.height, of.samples) {}
    const Job& job;
    std::mutex mutex; // of the canvas
    Canvas canvas;
};

std::vector<int> attributesFor(std::span<const Job> jobs, const CloudMetadata& metadata) {
    std::set<int> indices;
    for (const Job& job : jobs)
        for (std::string_view name : neededAttributes(job.style, metadata))
            indices.insert(metadata.schema.find(name));
    return {indices.begin(), indices.end()};
}

enum class Reading { nearest, blend };

bool wants(const Job& job, Reading reading) {
    return reading == Reading::nearest || job.style.splats.enabled;
}

// Reads the cloud once and draws it on every easel that wants it. `read` counts points.
Status drawAll(CloudReader& reader, Reading reading, std::vector<std::unique_ptr<Easel>>& easels,
               std::span<const int> attributes, int threads, const std::function<void(std::uint64_t)>& read) {
    const CloudMetadata& metadata = reader.metadata();
    Points shared;
    shared.grid = &metadata.grid;
    shared.colourIs8Bit = metadata.colourIs8Bit;
    for (int index : attributes)
        shared.attributes.push_back(metadata.schema.attributes[static_cast<std::size_t>(index)]);
    std::optional<FinestNodes> finest;
    if (std::any_of(easels.begin(), easels.end(),
                    [](const auto& easel) { return easel->job.style.sizeMode == PointSizeMode::adaptive; })) {
        STIPPLE_TRY(nodes, FinestNodes::of(reader));
        finest = std::move(nodes);
    }
    std::optional<LeafDensities> leaves;
    if (std::any_of(easels.begin(), easels.end(), [](const auto& easel) {
            return easel->job.style.detail.mode == DetailMode::continuous;
        })) {
        STIPPLE_TRY(densities, LeafDensities::of(reader));
        leaves = std::move(densities);
    }
    return visitPoints(reader, attributes, threads,
                       [&](const NodeKey& key, const PointBatch& batch, std::uint64_t firstOrder) {
                           Points points = shared;
                           points.batch = &batch;
                           points.level = key.level;
                           points.nodePoints = static_cast<double>(batch.size());
                           points.firstOrder = firstOrder;
                           if (leaves)
                               points.leafStep = leaves->stepOf(key);
                           if (finest)
                               points.spacings = finest->spacingsAt(batch);
                           std::vector<Mark> marks;
                           for (auto& easel : easels) {
                               if (!wants(easel->job, reading))
                                   continue;
                               marks.clear();
                               appendMarks(easel->job.view, easel->job.style, points, marks);
                               std::lock_guard lock(easel->mutex);
                               if (reading == Reading::nearest)
                                   easel->canvas.draw(marks, drawnShape(easel->job.style));
                               else
                                   easel->canvas.blend(marks, easel->job.style);
                           }
                           read(batch.size());
                       });
}

Status checkJobs(std::span<const Job> jobs) {
    for (const Job& job : jobs)
        if (std::min({job.view.width, job.view.height, job.samples}) < 1)
            return Error{ErrorCode::invalidArgument,
                         cat("a reference of ", job.view.width, " × ", job.view.height, " pixels with ",
                             job.samples, " samples can't be drawn"),
                         "", ""};
    return {};
}

// How many of the first jobs are drawn together.
std::size_t groupSize(std::span<const Job> jobs, std::uint64_t memoryBytes) {
    std::uint64_t bytes = 0;
    std::size_t count = 0;
    for (const Job& job : jobs) {
        bytes += Canvas::bytesFor(job.view.width, job.view.height, job.samples, job.style.splats.enabled);
        if (count > 0 && bytes > memoryBytes)
            break;
        ++count;
    }
    return count;
}

bool anyBlends(std::span<const Job> jobs) {
    return std::any_of(jobs.begin(), jobs.end(), [](const Job& job) { return wants(job, Reading::blend); });
}

std::size_t readingsOf(std::span<const Job> jobs, std::uint64_t memoryBytes) {
    std::size_t readings = 0;
    while (!jobs.empty()) {
        std::size_t group = groupSize(jobs, memoryBytes);
        readings += anyBlends(jobs.first(group)) ? 2 : 1;
        jobs = jobs.subspan(group);
    }
    return readings;
}

} // namespace

Result<std::vector<DepthImage>> renderCloud(ByteSource& source, std::span<const Job> jobs,
                                            const Options& options) {
    STIPPLE_CHECK(checkJobs(jobs));
    STIPPLE_TRY(reader, CloudReader::open(source));
    int threads = options.threads > 0 ? options.threads
                                      : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    std::uint64_t total = reader->metadata().pointCount * readingsOf(jobs, options.memoryBytes);
    std::atomic<std::uint64_t> done{0};
    std::mutex reporting;
    auto read = [&](std::uint64_t points) {
        std::uint64_t now = done += points;
        std::unique_lock lock(reporting, std::try_to_lock);
        if (options.progress && lock)
            options.progress(now, total);
    };

    std::vector<DepthImage> pictures;
    while (!jobs.empty()) {
        std::span<const Job> group = jobs.first(groupSize(jobs, options.memoryBytes));
        jobs = jobs.subspan(group.size());
        std::vector<std::unique_ptr<Easel>> easels;
        for (const Job& job : group)
            easels.push_back(std::make_unique<Easel>(job));
        std::vector<int> attributes = attributesFor(group, reader->metadata());
        STIPPLE_CHECK(drawAll(*reader, Reading::nearest, easels, attributes, threads, read));
        if (anyBlends(group))
            STIPPLE_CHECK(drawAll(*reader, Reading::blend, easels, attributes, threads, read));
        for (const auto& easel : easels)
            pictures.push_back(easel->canvas.finish(easel->job.style));
    }
    return pictures;
}

} // namespace stipple::reference
