// A byte source over a local file (POSIX). Answers inside read(). The file is opened once; if its size or
// modification time changes afterwards, reads answer `changed`.
#pragma once

#include "shared/io/byte_source.hpp"

#include <memory>

namespace stipple {

// Errors: notFound, ioFailed; invalidArgument for anything but a regular file.
Result<std::unique_ptr<ByteSource>> openFileSource(const std::string& path);

} // namespace stipple
