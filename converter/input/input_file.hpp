// Opening the file of an input so that Ctrl-C ends also what reads it from end to end.
#pragma once

#include "shared/io/byte_source.hpp"

#include <atomic>
#include <memory>
#include <string>

namespace stipple {

// As openFileSource; once `stop` (may be null) is true, every read answers `cancelled`. `stop` must outlive
// the source.
Result<std::unique_ptr<ByteSource>> openInputFile(const std::string& path, const std::atomic<bool>* stop);

} // namespace stipple
