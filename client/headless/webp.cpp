#include "client/headless/webp.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <webp/encode.h>

namespace stipple::headless {

namespace {

struct Picture {
    WebPPicture picture{};
    WebPMemoryWriter writer{};
    Picture() { WebPMemoryWriterInit(&writer); }
    ~Picture() {
        WebPPictureFree(&picture);
        WebPMemoryWriterClear(&writer);
    }
};

} // namespace

Result<Bytes> encodeWebp(const Image& image) {
    if (std::min(image.width, image.height) < 1 || std::max(image.width, image.height) > maxWebpSide)
        return Error{ErrorCode::invalidArgument,
                     cat("a picture of ", image.width, " × ", image.height, " pixels can't be coded as WebP"),
                     "", cat("each side must be in 1..", maxWebpSide)};
    constexpr int fastLevel = 1; // 0 fastest, 9 smallest
    WebPConfig config;
    Picture webp;
    bool isReady = WebPConfigInit(&config) && WebPConfigLosslessPreset(&config, fastLevel) &&
                   WebPPictureInit(&webp.picture);
    webp.picture.use_argb = 1;
    webp.picture.width = image.width;
    webp.picture.height = image.height;
    webp.picture.writer = WebPMemoryWrite;
    webp.picture.custom_ptr = &webp.writer;
    if (!isReady || !WebPPictureImportRGBX(&webp.picture, image.rgba.data(), 4 * image.width) ||
        !WebPEncode(&config, &webp.picture))
        return Error{
            ErrorCode::ioFailed,
            cat("the picture can't be coded as WebP: error ", static_cast<int>(webp.picture.error_code)), "",
            ""};
    return Bytes(webp.writer.mem, webp.writer.mem + webp.writer.size);
}

} // namespace stipple::headless
