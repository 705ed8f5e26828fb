// Phase 4: the nodes into the file.
#pragma once

#include "converter/build/convert.hpp"
#include "converter/build/sample.hpp"

namespace stipple {

// Encodes every node (in parallel), writes them and completes `metadata` with the statistics. Fails with
// `corrupt` if the hash over the packed points is not the one summed while reading: then the output does not
// get its name. What the output is at fault for is writeFailed.
Result<WrittenCloud> pack(const Tiles& tiles, const Sampled& sampled, CloudMetadata& metadata,
                          const std::string& output, int threads, const std::atomic<bool>* stop,
                          const ConvertProgress& progress);

} // namespace stipple
