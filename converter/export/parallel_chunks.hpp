// Compresses the chunks of a LAZ file on several threads.
#pragma once

#include "shared/las/chunk_work.hpp"

#include <functional>
#include <memory>

namespace stipple {

// For las::WriterOptions::makeChunkWork: `threads` of them, of which one is that which writes, while it
// waits. At most two chunks for each wait (of some 50,000 records each). Nothing for one thread.
std::function<std::unique_ptr<las::ChunkWork>()> parallelChunks(int threads);

} // namespace stipple
