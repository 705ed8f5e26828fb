// Any bytes as a LAZ file: open it, read its points in two orders; where both succeed they agree.
#include "shared/io/memory_source.hpp"
#include "shared/las/las_reader.hpp"

#include <algorithm>
#include <cstdlib>

using namespace stipple;

namespace {

constexpr std::uint64_t mostPoints = 3000;

void require(bool condition) {
    if (!condition)
        std::abort();
}

// Points [first, first + count), or none if they can't be read.
bool read(las::Reader& reader, std::uint64_t first, std::uint64_t count, PointBatch& points) {
    Status status = reader.read(first, count, points);
    require(status.ok() || (!status.error().sentence().empty() && points.size() == 0));
    return status.ok();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    MemorySource source(Bytes(data, data + size));
    auto opened = las::Reader::open(source);
    if (!opened.ok()) {
        require(!opened.error().sentence().empty());
        return 0;
    }
    las::Reader& reader = **opened;
    auto starts = reader.chunkStarts();
    require(std::is_sorted(starts.begin(), starts.end()) && (starts.empty() || starts[0] == 0));
    // Records of 64 KiB would only take time.
    const std::uint64_t count = std::min<std::uint64_t>(
        {reader.pointCount(), mostPoints, std::uint64_t{1 << 20} / reader.header().recordLength});
    PointBatch whole, part;
    bool readable = read(reader, 0, count, whole);
    for (std::uint64_t first : {count / 2, count / 3, std::uint64_t{0}})
        if (read(reader, first, count / 4, part) && readable)
            for (std::size_t i = 0; i < part.size(); ++i)
                require(part.positions[i] == whole.positions[static_cast<std::size_t>(first) + i]);
    const std::string chosen[] = {"Intensity", "Red"};
    reader.select(chosen);
    read(reader, 0, count, part);
    return 0;
}
