// laz_bench FILE.laz [REPEATS]: millions of points a second that a LAZ file is decoded to columns and its
// records are encoded again, with one thread and (natively) with two, each in chunks of its own. The fastest
// of REPEATS runs (3) counts. The file is in memory.
#include "shared/io/file_source.hpp"
#include "shared/io/memory_source.hpp"
#include "shared/las/las_reader.hpp"
#include "shared/las/laz/chunk_reader.hpp"
#include "shared/las/laz/layered_chunk.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#ifndef __EMSCRIPTEN__
#include <thread>
#endif

namespace {

using namespace stipple;

constexpr std::uint64_t batchPoints = 65536;

template <class T>
T need(Result<T> result) {
    if (!result.ok()) {
        std::fprintf(stderr, "%s\n", result.error().sentence().c_str());
        std::exit(1);
    }
    return std::move(result).value();
}
void need(const Status& status) {
    if (!status.ok()) {
        std::fprintf(stderr, "%s\n", status.error().sentence().c_str());
        std::exit(1);
    }
}

// Processor time of one thread, so that other programs do not count; Emscripten has only the wall clock.
double seconds(std::size_t threads) {
#ifndef __EMSCRIPTEN__
    if (threads == 1)
        return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
#endif
    (void)threads;
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double fastest(int repeats, std::size_t threads, const std::function<void()>& run) {
    double best = 1e9;
    for (int i = 0; i < repeats; ++i) {
        double start = seconds(threads);
        run();
        best = std::min(best, seconds(threads) - start);
    }
    return best;
}

// Part `part` of `parts`: the points between two chunk starts.
std::pair<std::uint64_t, std::uint64_t> pointsOf(const las::Reader& reader, std::size_t part,
                                                 std::size_t parts) {
    auto starts = reader.chunkStarts();
    auto border = [&](std::size_t p) {
        std::size_t chunk = p * starts.size() / parts;
        return chunk < starts.size() ? starts[chunk] : reader.pointCount();
    };
    return {border(part), border(part + 1)};
}

void inThreads(std::size_t threads, const std::function<void(std::size_t)>& run) {
#ifdef __EMSCRIPTEN__
    for (std::size_t i = 0; i < threads; ++i)
        run(i);
#else
    std::vector<std::thread> others;
    for (std::size_t i = 1; i < threads; ++i)
        others.emplace_back(run, i);
    run(0);
    for (std::thread& other : others)
        other.join();
#endif
}

void decodeAll(const las::Reader& opened, const Bytes& file, std::size_t threads) {
    inThreads(threads, [&](std::size_t part) {
        MemorySource source(file);
        auto reader = need(opened.openAnother(source));
        auto [first, end] = pointsOf(*reader, part, threads);
        PointBatch batch;
        for (; first < end; first += batchPoints)
            need(reader->read(first, std::min(batchPoints, end - first), batch));
    });
}

// The file's points as records, without their way through columns.
Bytes recordsOf(ByteSource& source, const las::Reader& reader, const las::laz::ChunkIndex& index) {
    las::laz::ChunkReader chunks(source, std::make_shared<las::laz::ChunkIndex>(index));
    Bytes records(static_cast<std::size_t>(reader.pointCount()) * index.recordLength);
    need(chunks.seek(0));
    need(chunks.read(records));
    return records;
}

std::size_t encodeAll(const Bytes& records, const las::Header& header, std::size_t threads) {
    const las::laz::LaszipRecord how = las::laz::laszipRecordFor(header.pointFormat, header.recordLength);
    const std::size_t chunkBytes = std::size_t{how.chunkSize} * header.recordLength;
    std::vector<std::size_t> sizes(threads);
    inThreads(threads, [&](std::size_t part) {
        auto encoder = header.pointFormat >= 6 ? need(las::laz::makeLayeredEncoder(how.items))
                                               : las::laz::makePointwiseEncoder(how.items);
        for (std::size_t at = part * chunkBytes; at < records.size(); at += threads * chunkBytes) {
            encoder->start();
            encoder->encode(ByteSpan(records).subspan(at, std::min(chunkBytes, records.size() - at)));
            sizes[part] += encoder->finish().size();
        }
    });
    std::size_t total = 0;
    for (std::size_t size : sizes)
        total += size;
    return total;
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fprintf(stderr, "usage: laz_bench FILE.laz [REPEATS]\n");
        return 2;
    }
    const int repeats = argc > 2 ? std::max(1, std::atoi(argv[2])) : 3;
    auto disk = need(openFileSource(argv[1]));
    Bytes file = need(readNow(*disk, {0, ~0ull >> 1}));
    MemorySource source(file);
    auto reader = need(las::Reader::open(source));
    const las::Header& header = reader->header();
    const double points = static_cast<double>(reader->pointCount());
    std::printf("%s: format %d, %.0f points, %zu chunks, %.2f bytes a point\n", argv[1], header.pointFormat,
                points, reader->chunkStarts().size(), static_cast<double>(file.size()) / points);
    if (!header.compressed || reader->pointCount() == 0)
        return 0;
    std::vector<std::string> warnings;
    auto index = need(las::laz::readChunkIndex(source, header, file.size(), warnings));
    const Bytes records = recordsOf(source, *reader, index);
#ifdef __EMSCRIPTEN__
    constexpr std::size_t mostThreads = 1;
#else
    constexpr std::size_t mostThreads = 2;
#endif
    for (std::size_t threads = 1; threads <= mostThreads; ++threads) {
        double decode = fastest(repeats, threads, [&] { decodeAll(*reader, file, threads); });
        std::size_t bytes = 0;
        double encode = fastest(repeats, threads, [&] { bytes = encodeAll(records, header, threads); });
        std::printf("%zu thread%s: decode %6.2f  encode %6.2f million points a second (%.2f bytes a point)\n",
                    threads, threads == 1 ? "" : "s", points / decode / 1e6, points / encode / 1e6,
                    static_cast<double>(bytes) / points);
    }
    return 0;
}
