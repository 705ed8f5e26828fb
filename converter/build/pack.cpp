#include "converter/build/pack.hpp"

#include "converter/build/parallel.hpp"
#include "converter/build/statistics.hpp"
#include "shared/base/text.hpp"

#include <mutex>

namespace stipple {

namespace {
// An error of the writer is one of the output.
Error ofOutput(Error error, const std::string& output) {
    if (error.code == ErrorCode::ioFailed || error.code == ErrorCode::notFound)
        error.code = ErrorCode::writeFailed;
    return error.where.find(output) == std::string::npos ? error.at(output) : error;
}

struct Worker {
    std::vector<std::uint32_t> indices;
    PointBatch batch;
    PointHash hash;
};
} // namespace

Result<WrittenCloud> pack(const Tiles& tiles, const Sampled& sampled, CloudMetadata& metadata,
                          const std::string& output, int threads, const std::atomic<bool>* stop,
                          const ConvertProgress& progress) {
    auto created = CloudWriter::create(output);
    if (!created)
        return ofOutput(created.error(), output);
    CloudWriter& writer = **created;

    std::vector<Worker> workers(static_cast<std::size_t>(threads));
    std::vector<BatchStatistics> statistics(tiles.nodes.size());
    std::mutex writing;
    std::uint64_t done = 0;
    STIPPLE_CHECK(parallelFor(tiles.nodes.size(), threads, stop, [&](std::size_t i, int w) -> Status {
        if (sampled.kept[i].empty())
            return {};
        Worker& worker = workers[static_cast<std::size_t>(w)];
        worker.indices.clear();
        for (std::uint32_t rank : sampled.kept[i])
            worker.indices.push_back(tiles.order[rank]);
        tiles.points.store.gather(worker.indices, worker.batch);
        worker.hash.add(metadata.schema, worker.batch);
        statistics[i] = statisticsOf(metadata.schema, worker.batch);
        STIPPLE_TRY(encoded, encodeNode(metadata, tiles.nodes[i].key, worker.batch));

        std::lock_guard lock(writing);
        if (Status added = writer.add(encoded); !added)
            return ofOutput(added.error(), output);
        done += worker.batch.size();
        progress("pack", done, metadata.pointCount);
        return {};
    }));

    BatchStatistics all = emptyStatistics(metadata.schema);
    for (const BatchStatistics& node : statistics)
        if (!node.empty())
            merge(all, node);
    metadata.statistics.clear();
    for (const PartialStatistics& attribute : all)
        metadata.statistics.push_back(attribute.finish());

    PointHash hash;
    for (const Worker& worker : workers)
        hash.add(worker.hash);
    if (hash != tiles.points.hash || done != metadata.pointCount)
        return Error{ErrorCode::corrupt,
                     cat("the points packed are not the points read (", done, " of ", metadata.pointCount,
                         ", hash ", hash.hex(), ", read ", tiles.points.hash.hex(), ")"),
                     output, "this is a fault of stipple or of the memory; nothing was written"};
    auto written = writer.finish(metadata);
    if (!written)
        return ofOutput(written.error(), output);
    return std::move(written).value();
}

} // namespace stipple
