#include "client/web/cloud_message.hpp"

#include "client/web/message_text.hpp"
#include "shared/format/picture_attributes.hpp"

namespace stipple::web {
namespace {

constexpr std::uint32_t cloudMark = 0x314C4353;        // "SCL1"
constexpr std::size_t leastAttributeBytes = 4 + 1 + 1; // no name, type, components

// Of an enumeration whose last value is `last`; a greater one ends in an error.
template <class Enum>
bool readEnum(ByteReader& in, Enum& value, Enum last) {
    auto number = in.read<std::uint8_t>();
    value = static_cast<Enum>(number);
    return number <= static_cast<std::uint8_t>(last);
}

bool readAttribute(ByteReader& in, Attribute& attribute) {
    attribute.name = readText(in);
    bool known = readEnum(in, attribute.type, AttributeType::f64);
    attribute.components = in.read<std::uint8_t>();
    return known && attribute.components > 0;
}

bool readCloud(ByteReader& in, CloudMetadata& metadata) {
    bool valid = in.read<std::uint32_t>() == cloudMark;
    for (int axis = 0; axis < 3; ++axis)
        metadata.rootCube.min[axis] = in.read<std::int64_t>();
    metadata.rootCube.bits = in.read<std::uint8_t>();
    valid = valid && metadata.rootCube.bits <= maxRootBits;
    valid = readEnum(in, metadata.pictureColour, PictureColour::intensity) && valid;
    valid = readEnum(in, metadata.innerColour, InnerColour::mean) && valid;
    metadata.colourIs8Bit = in.read<std::uint8_t>() != 0;
    std::uint32_t count = in.read<std::uint32_t>();
    if (!valid || count > in.remaining() / leastAttributeBytes)
        return false;
    metadata.schema.attributes.resize(count);
    for (Attribute& attribute : metadata.schema.attributes)
        valid = readAttribute(in, attribute) && valid;
    return valid && in.ok() && in.remaining() == 0 && checkPictureAttributes(metadata).ok();
}

} // namespace

Bytes encodeCloud(const CloudMetadata& metadata) {
    ByteWriter out;
    out.write(cloudMark);
    for (int axis = 0; axis < 3; ++axis)
        out.write(metadata.rootCube.min[axis]);
    out.write(static_cast<std::uint8_t>(metadata.rootCube.bits));
    out.write(metadata.pictureColour);
    out.write(metadata.innerColour);
    out.write(static_cast<std::uint8_t>(metadata.colourIs8Bit));
    out.write(static_cast<std::uint32_t>(metadata.schema.attributes.size()));
    for (const Attribute& attribute : metadata.schema.attributes) {
        writeText(out, attribute.name);
        out.write(attribute.type);
        out.write(static_cast<std::uint8_t>(attribute.components));
    }
    return out.take();
}

Result<CloudMetadata> decodeCloud(ByteSpan message) {
    ByteReader in(message);
    CloudMetadata metadata;
    if (!readCloud(in, metadata))
        return Error{ErrorCode::corrupt, say("a message does not describe a cloud"), "decoding worker",
                     say("reload the page")};
    return metadata;
}

} // namespace stipple::web
