#include "shared/codec/column_codec.hpp"

#include "shared/base/text.hpp"
#include "shared/codec/section.hpp"

#include <algorithm>

namespace stipple {

namespace {

enum class Method : std::uint8_t { constant = 0, plain = 1 };

} // namespace

// per component: [u8 method] [constant: the value] [plain: section]
void encodeColumn(ByteWriter& to, ByteSpan values, std::size_t width, std::size_t components) {
    std::size_t stride = width * components, count = values.size() / stride;
    for (std::size_t c = 0; c < components; ++c) {
        Bytes own(count * width);
        for (std::size_t i = 0; i < count; ++i)
            std::memcpy(own.data() + i * width, values.data() + i * stride + c * width, width);
        bool constant = std::equal(own.begin() + static_cast<std::ptrdiff_t>(std::min(width, own.size())),
                                   own.end(), own.begin());
        if (constant && count > 0) {
            to.write(Method::constant);
            to.writeBytes(ByteSpan(own).first(width));
            continue;
        }
        to.write(Method::plain);
        writeSection(to, own, Effort::thorough);
    }
}

Result<Bytes> decodeColumn(ByteReader& from, std::size_t pointCount, std::size_t width,
                           std::size_t components) {
    std::size_t stride = width * components;
    Bytes values(pointCount * stride);
    Bytes own(pointCount * width);
    for (std::size_t c = 0; c < components; ++c) {
        auto method = from.read<Method>();
        if (method == Method::constant) {
            ByteSpan value = from.readBytes(width);
            if (!from.ok())
                return Error{ErrorCode::truncated, "a constant ends early", {}, {}};
            for (std::size_t i = 0; i < pointCount; ++i)
                std::memcpy(values.data() + i * stride + c * width, value.data(), width);
        } else if (method == Method::plain && from.ok()) {
            STIPPLE_CHECK(readFullSection(from, own));
            for (std::size_t i = 0; i < pointCount; ++i)
                std::memcpy(values.data() + i * stride + c * width, own.data() + i * width, width);
        } else {
            return Error{ErrorCode::corrupt, "unknown way to store an attribute", {}, {}};
        }
    }
    return values;
}

} // namespace stipple
