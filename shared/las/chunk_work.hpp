// Who compresses the chunks of a LAZ file that is being written.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <cstddef>
#include <functional>

namespace stipple::las {

// Chunks are compressed apart from each other, so several threads may do it; their bytes go into the file in
// order. All calls come from the thread that writes. What was submitted and not taken when this is destroyed
// need not be done, but must have ended.
class ChunkWork {
  public:
    virtual ~ChunkWork() = default;
    virtual void submit(std::function<Bytes()> compress) = 0; // to be run once, on any thread
    virtual std::size_t waiting() const = 0;                  // submitted and not taken
    virtual std::size_t mostWaiting() const = 0;              // so many chunks may wait; at least 1
    // The bytes of the oldest that waits. Errors: outOfMemory, if it could not be run.
    virtual Result<Bytes> take() = 0;
};

} // namespace stipple::las
