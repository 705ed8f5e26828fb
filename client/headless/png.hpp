// PNG files, 8 bits a channel.
#pragma once

#include "client/render/image.hpp"
#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace stipple::headless {

// A PNG that claims more pixels than this is refused before any memory is taken for it.
inline constexpr std::uint64_t maxPngPixels = 1ull << 28;

// Takes the next bytes of a file.
using TakeBytes = std::function<Status(ByteSpan)>;

// A PNG of sRGB pixels, written as its rows come.
class PngWriter {
  public:
    // Errors: of `take`; invalidArgument for a picture without pixels, or too wide for libpng (a million).
    static Result<std::unique_ptr<PngWriter>> begin(int width, int height, TakeBytes take);
    virtual ~PngWriter() = default;
    // The next rows, in the picture's width. Errors: of `take`; invalidArgument for rows that the picture has
    // not.
    virtual Status append(const Image& rows) = 0;
    // After the last row.
    virtual Status finish() = 0;
};

// As RGB. Error: invalidArgument for a picture without pixels.
Result<Bytes> encodePng(const Image& image);

// Writes RGB. The file appears under `path` only when it is complete; errors are those of
// shared/io/output_file.hpp.
Status writePng(const std::string& path, const Image& image);

// Reads any PNG as RGBA with A = 255 (transparency is dropped). Errors: notFound, ioFailed, corrupt,
// limitExceeded.
Result<Image> readPng(const std::string& path);

} // namespace stipple::headless
