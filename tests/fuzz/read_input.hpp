// Any bytes as a file of points: opened, and read to the end as it was described.
#pragma once

#include "converter/input/open.hpp"
#include "converter/input/shared_source.hpp"
#include "shared/io/memory_source.hpp"

#include <cstdio>
#include <cstdlib>

namespace stipple::fuzz {

inline void require(bool condition, const char* what) {
    if (condition)
        return;
    std::fprintf(stderr, "%s\n", what);
    std::abort();
}

template <class Open>
int readInput(Open open, const std::uint8_t* data, std::size_t size) {
    auto input =
        open("scan",
             std::make_unique<SharedSource>(std::make_unique<MemorySource>(Bytes(data, data + size), "scan")),
             InputOptions{});
    if (!input) {
        require(!input.error().sentence().empty(), "an error says nothing");
        return 0;
    }
    const InputDescription& description = (*input)->description();
    std::uint64_t points = 0;
    BoxI bounds;
    PointBatch batch;
    for (std::size_t part = 0; part < (*input)->parts().size(); ++part) {
        auto stream = (*input)->openPart(part);
        require(stream.ok(), "a part does not open");
        std::uint64_t count = 0;
        do {
            require((*stream)->next(batch).ok(), "what was measured can't be read");
            count += batch.size();
            for (Vec3i p : batch.positions)
                bounds.extend(p);
        } while (batch.size() > 0);
        require(count == (*input)->parts()[part].points, "a part has other points than it says");
        points += count;
    }
    require(points == description.source.pointCount, "the input has other points than it says");
    require(bounds == description.bounds, "the input has other bounds than it says");
    return 0;
}

} // namespace stipple::fuzz
