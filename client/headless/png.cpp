#include "client/headless/png.hpp"

#include "shared/base/text.hpp"
#include "shared/io/output_file.hpp"

#include <png.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

namespace stipple::headless {
namespace {

Error openError(const std::string& path) {
    ErrorCode code = errno == ENOENT ? ErrorCode::notFound : ErrorCode::ioFailed;
    return {code, cat("opening the picture failed: ", std::strerror(errno)), path, ""};
}

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

// libpng's simplified interface frees through this, whichever way the function is left.
struct PngImage {
    png_image image{};
    PngImage() { image.version = PNG_IMAGE_VERSION; }
    ~PngImage() { png_image_free(&image); }
};

} // namespace

Result<Bytes> encodePng(const Image& image) {
    std::size_t pixels = image.rgba.size() / 4;
    std::vector<std::uint8_t> rgb(pixels * 3);
    for (std::size_t i = 0; i < pixels; ++i)
        std::memcpy(&rgb[3 * i], &image.rgba[4 * i], 3);

    PngImage png;
    png.image.width = static_cast<png_uint_32>(image.width);
    png.image.height = static_cast<png_uint_32>(image.height);
    png.image.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png.image);
    Bytes encoded(size);
    if (!png_image_write_to_memory(&png.image, encoded.data(), &size, 0, rgb.data(), 0, nullptr))
        return Error{ErrorCode::invalidArgument,
                     cat("the picture can't be coded as PNG: ", png.image.message), "", ""};
    encoded.resize(size);
    return encoded;
}

Status writePng(const std::string& path, const Image& image) {
    STIPPLE_TRY(encoded, encodePng(image));
    STIPPLE_TRY(file, OutputFile::create(path));
    STIPPLE_CHECK(file->append(encoded));
    return file->commit();
}

Result<Image> readPng(const std::string& path) {
    File file(std::fopen(path.c_str(), "rb"));
    if (!file)
        return openError(path);
    PngImage png;
    if (!png_image_begin_read_from_stdio(&png.image, file.get()))
        return Error{ErrorCode::corrupt, cat("this is not a readable PNG: ", png.image.message), path, ""};
    std::uint64_t pixels = std::uint64_t{png.image.width} * png.image.height;
    if (pixels > maxPngPixels)
        return Error{ErrorCode::limitExceeded,
                     cat("a picture of ", png.image.width, " × ", png.image.height, " pixels is too large"),
                     path, ""};
    png.image.format = PNG_FORMAT_RGBA;
    Image image{static_cast<int>(png.image.width), static_cast<int>(png.image.height), {}};
    image.rgba.resize(pixels * 4);
    if (!png_image_finish_read(&png.image, nullptr, image.rgba.data(), 0, nullptr))
        return Error{ErrorCode::corrupt, cat("this is not a readable PNG: ", png.image.message), path, ""};
    for (std::size_t i = 3; i < image.rgba.size(); i += 4)
        image.rgba[i] = 255;
    return image;
}

} // namespace stipple::headless
