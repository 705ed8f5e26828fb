// Standard output as a sink of bytes: they leave at once and can't be written again. Errors: writeFailed.
#pragma once

#include "shared/io/byte_sink.hpp"

#include <memory>

namespace stipple {

std::unique_ptr<ByteSink> standardOutputSink();

} // namespace stipple
