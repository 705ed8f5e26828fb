// PNG files, 8 bits a channel.
#pragma once

#include "client/render/image.hpp"
#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <cstdint>
#include <string>

namespace stipple::headless {

// A PNG that claims more pixels than this is refused before any memory is taken for it.
inline constexpr std::uint64_t maxPngPixels = 1ull << 28;

// As RGB. Error: invalidArgument for a picture without pixels.
Result<Bytes> encodePng(const Image& image);

// Writes RGB. The file appears under `path` only when it is complete; errors are those of
// shared/io/output_file.hpp.
Status writePng(const std::string& path, const Image& image);

// Reads any PNG as RGBA with A = 255 (transparency is dropped). Errors: notFound, ioFailed, corrupt,
// limitExceeded.
Result<Image> readPng(const std::string& path);

} // namespace stipple::headless
