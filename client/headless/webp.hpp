// WebP pictures, 8 bits a channel.
#pragma once

#include "client/render/image.hpp"
#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

namespace stipple::headless {

inline constexpr int maxWebpSide = 16383;

// As RGB, lossless: the pixels are those of the PNG. Errors: invalidArgument for a picture without pixels or
// with a side over maxWebpSide; ioFailed.
Result<Bytes> encodeWebp(const Image& image);

} // namespace stipple::headless
