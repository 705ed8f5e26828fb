#include "client/headless/png.hpp"

#include "shared/base/text.hpp"
#include "shared/io/output_file.hpp"

#include <png.h>

#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

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

// libpng leaves its functions by longjmp where something fails: what is called in `call` has no destructors.
template <class Call>
bool succeeds(png_structp png, const Call& call) {
    if (setjmp(png_jmpbuf(png)) != 0)
        return false;
    call();
    return true;
}

class RowWriter final : public PngWriter {
  public:
    RowWriter(int width, int height, TakeBytes take)
        : width_(width), rowsLeft_(height), take_(std::move(take)),
          png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, this, &RowWriter::fail, &RowWriter::pass)),
          info_(png_ ? png_create_info_struct(png_) : nullptr) {}
    ~RowWriter() override { png_destroy_write_struct(&png_, &info_); }

    Status start() {
        if (!info_)
            return Error{ErrorCode::limitExceeded, "there is no memory to code a picture as PNG", "", ""};
        auto width = static_cast<png_uint_32>(width_), height = static_cast<png_uint_32>(rowsLeft_);
        return answer(succeeds(png_, [&] {
            png_set_write_fn(png_, this, &RowWriter::write, nullptr);
            png_set_IHDR(png_, info_, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                         PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
            png_set_sRGB(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
            png_write_info(png_, info_);
            png_set_filler(png_, 0, PNG_FILLER_AFTER);
        }));
    }

    Status append(const Image& rows) override {
        if (rows.width != width_ || rows.height > rowsLeft_)
            return Error{ErrorCode::invalidArgument, "these are not the picture's rows", "", ""};
        rowsLeft_ -= rows.height;
        std::size_t rowBytes = 4 * static_cast<std::size_t>(width_);
        return answer(succeeds(png_, [&] {
            for (std::size_t y = 0; y < static_cast<std::size_t>(rows.height); ++y)
                png_write_row(png_, rows.rgba.data() + y * rowBytes);
        }));
    }

    Status finish() override {
        return answer(succeeds(png_, [&] { png_write_end(png_, info_); }));
    }

  private:
    Status answer(bool ok) {
        if (ok)
            return {};
        if (!failed_.ok())
            return failed_;
        return Error{ErrorCode::invalidArgument, cat("the picture can't be coded as PNG: ", message_), "",
                     ""};
    }

    static void fail(png_structp png, png_const_charp message) {
        static_cast<RowWriter*>(png_get_error_ptr(png))->message_ = message;
        png_longjmp(png, 1);
    }
    static void pass(png_structp, png_const_charp) {} // warnings, of which writing has none that matters
    static void write(png_structp png, png_bytep bytes, std::size_t size) {
        auto* self = static_cast<RowWriter*>(png_get_io_ptr(png));
        self->failed_ = self->take_(ByteSpan(bytes, size));
        if (!self->failed_.ok())
            png_error(png, "its bytes can't be kept");
    }

    int width_, rowsLeft_;
    TakeBytes take_;
    Status failed_;
    std::string message_;
    png_structp png_;
    png_infop info_;
};

} // namespace

Result<std::unique_ptr<PngWriter>> PngWriter::begin(int width, int height, TakeBytes take) {
    auto writer = std::make_unique<RowWriter>(width, height, std::move(take));
    STIPPLE_CHECK(writer->start());
    return std::unique_ptr<PngWriter>(std::move(writer));
}

Result<Bytes> encodePng(const Image& image) {
    Bytes encoded;
    STIPPLE_TRY(writer, PngWriter::begin(image.width, image.height, [&](ByteSpan bytes) {
                    encoded.insert(encoded.end(), bytes.begin(), bytes.end());
                    return Status();
                }));
    STIPPLE_CHECK(writer->append(image));
    STIPPLE_CHECK(writer->finish());
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
