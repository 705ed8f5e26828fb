#include "converter/input/pcd_lzf.hpp"

#include "shared/base/text.hpp"

#include <algorithm>

namespace stipple {

namespace {
constexpr std::size_t inputBlockBytes = std::size_t{1} << 16; // small: there is a decoder for each field
}

LzfDecoder::LzfDecoder(SharedSource& source, const LzfPlace& place, std::uint64_t fileEnd,
                       std::uint64_t outputEnd)
    : cursor_(source, place.fileOffset, inputBlockBytes), fileEnd_(fileEnd), outputEnd_(outputEnd),
      name_(source.name()), buffer_(bufferBytes + mostTokenBytes), decoded_(place.window.size()),
      tokenBegin_(decoded_), bufferOutput_(place.outputOffset - place.window.size()),
      tokenFileOffset_(place.fileOffset), given_(place.outputOffset) {
    std::copy(place.window.begin(), place.window.end(), buffer_.begin());
}

Status LzfDecoder::read(std::uint8_t* to, std::uint64_t count) {
    while (count > 0) {
        std::uint64_t ready = bufferOutput_ + decoded_ - given_;
        if (ready == 0) {
            STIPPLE_CHECK(decodeToken());
            continue;
        }
        std::size_t part = static_cast<std::size_t>(std::min(ready, count));
        if (to != nullptr) {
            std::copy_n(buffer_.data() + (given_ - bufferOutput_), part, to);
            to += part;
        }
        given_ += part;
        count -= part;
    }
    return {};
}

LzfPlace LzfDecoder::place() const {
    LzfPlace place;
    // Between tokens the next one is the place; within one, that one.
    const bool between = given_ == bufferOutput_ + decoded_;
    const std::size_t end = between ? decoded_ : tokenBegin_;
    const std::size_t begin = end - std::min(end, lzfWindowBytes);
    place.fileOffset = between ? cursor_.offset() : tokenFileOffset_;
    place.outputOffset = bufferOutput_ + end;
    place.window.assign(buffer_.begin() + static_cast<std::ptrdiff_t>(begin),
                        buffer_.begin() + static_cast<std::ptrdiff_t>(end));
    return place;
}

Status LzfDecoder::decodeToken() {
    if (decoded_ > bufferBytes) {
        const std::size_t thrown = decoded_ - lzfWindowBytes;
        std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(thrown),
                  buffer_.begin() + static_cast<std::ptrdiff_t>(decoded_), buffer_.begin());
        decoded_ = lzfWindowBytes;
        bufferOutput_ += thrown;
    }
    tokenBegin_ = decoded_;
    tokenFileOffset_ = cursor_.offset();
    constexpr std::size_t mostInput = 33;
    STIPPLE_TRY(peeked, cursor_.peek(mostInput));
    ByteSpan in = peeked.first(static_cast<std::size_t>(
        std::min<std::uint64_t>(peeked.size(), fileEnd_ - std::min(fileEnd_, cursor_.offset()))));
    if (in.empty())
        return damaged("the compressed points end early");
    const std::size_t control = in[0];
    constexpr std::size_t literals = 32, longMatch = 7;
    std::size_t length = 0, used = 0, back = 0;
    if (control < literals) {
        length = control + 1;
        used = 1 + length;
    } else {
        length = control >> 5;
        used = length == longMatch ? 3 : 2;
        if (in.size() >= used) {
            length += length == longMatch ? in[1] : 0u;
            length += 2;
            back = ((control & 31) << 8 | in[used - 1]) + 1;
        }
    }
    if (in.size() < used)
        return damaged("the compressed points end early");
    if (back > decoded_)
        return damaged("the compressed points refer to bytes before the first");
    if (bufferOutput_ + decoded_ + length > outputEnd_)
        return damaged("the compressed points are more than the header states");
    std::uint8_t* out = buffer_.data() + decoded_;
    if (back == 0)
        std::copy_n(in.begin() + 1, length, out);
    else
        for (std::size_t i = 0; i < length; ++i) // byte by byte: it may repeat what it writes
            out[i] = out[static_cast<std::ptrdiff_t>(i) - static_cast<std::ptrdiff_t>(back)];
    decoded_ += length;
    cursor_.skip(used);
    return {};
}

Error LzfDecoder::damaged(const char* what) const {
    return {ErrorCode::corrupt, what, cat(name_, ", byte ", cursor_.offset()), "the file is damaged"};
}

} // namespace stipple
