// The reference: pictures of a whole cloud, which every other way of drawing is measured against. Every point
// in double precision from its exact integers, no level of detail, no budget, no float, no snapping; nothing
// of the renderers' or the client's projection. For tests and `stipple bench`: it draws a million points a
// second, not a hundred.
//
// Where a new way to draw goes: sizes and colours into marks, shapes and what is done with several marks on a
// pixel into canvas; `referenceVersion` grows.
//
// The cloud is read node by node, all pictures of one reading at once (twice for splats); memory is that of
// the pictures (Canvas::bytesFor), of which so many are drawn at a time as `memoryBytes` holds, at least one.
#pragma once

#include "client/reference/canvas.hpp"
#include "shared/base/result.hpp"
#include "shared/io/byte_source.hpp"

#include <functional>
#include <span>
#include <vector>

namespace stipple::reference {

// Of the pictures: what is kept of an older one is no longer right.
inline constexpr int referenceVersion = 2;

struct Job {
    View view;
    Style style; // with ranges: min < max
    int samples = 1;
};

struct Options {
    int threads = 0; // 0: one per core
    std::uint64_t memoryBytes = 1ull << 30;
    // Called now and then with the points read so far and those of all readings together.
    std::function<void(std::uint64_t done, std::uint64_t total)> progress;
};

// One picture for each job. Errors: those of reading and of the file's bytes; invalidArgument for a picture
// without pixels or samples.
Result<std::vector<DepthImage>> renderCloud(ByteSource& source, std::span<const Job> jobs,
                                            const Options& options = {});

} // namespace stipple::reference
