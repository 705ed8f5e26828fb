#include "shared/las/header_block.hpp"

#include "shared/base/text.hpp"

namespace stipple::las {

namespace {

Error headerError(ErrorCode code, std::string what, std::size_t atByte, std::string advice = "") {
    return {code, std::move(what), cat("header byte ", atByte), std::move(advice)};
}

// Length of the UTF-8 sequence at `at`, or 0 if there is none (RFC 3629 §4).
std::size_t sequenceLength(const std::string& text, std::size_t at) {
    auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<std::uint8_t>(text[i]) : 0u; };
    unsigned first = byte(at);
    if (first < 0x80)
        return 1;
    std::size_t length = first >= 0xF5 ? 0 : first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : first >= 0xC2 ? 2 : 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(at + i) & 0xC0) != 0x80)
            return 0;
    unsigned second = byte(at + 1);
    bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
    bool beyond = (first == 0xED && second >= 0xA0) || (first == 0xF4 && second >= 0x90);
    return overlong || beyond ? 0 : length;
}

bool isUtf8(const std::string& text) {
    for (std::size_t at = 0; at < text.size();) {
        std::size_t length = sequenceLength(text, at);
        if (length == 0)
            return false;
        at += length;
    }
    return true;
}

Vec3d readVec3d(ByteReader& reader) {
    Vec3d v;
    v.x = reader.read<double>();
    v.y = reader.read<double>();
    v.z = reader.read<double>();
    return v;
}

void decodeLongFields(ByteReader& reader, HeaderBlock& block) {
    if (block.hasWaveformOffset())
        block.waveformOffset = reader.read<std::uint64_t>();
    if (!block.hasLongCounts())
        return;
    block.evlrOffset = reader.read<std::uint64_t>();
    block.evlrCount = reader.read<std::uint32_t>();
    block.pointCount = reader.read<std::uint64_t>();
    for (std::uint64_t& count : block.pointsByReturn)
        count = reader.read<std::uint64_t>();
}

} // namespace

std::size_t headerBlockSize(int versionMinor) {
    return versionMinor >= 4 ? maxHeaderBlockSize : versionMinor == 3 ? 235 : minHeaderBlockSize;
}

std::string readableText(std::string text) {
    if (!isUtf8(text)) {
        std::string converted;
        for (char c : text) {
            auto byte = static_cast<std::uint8_t>(c);
            if (byte < 0x80) {
                converted += c;
            } else {
                converted += static_cast<char>(0xC0 | (byte >> 6));
                converted += static_cast<char>(0x80 | (byte & 0x3F));
            }
        }
        text = std::move(converted);
    }
    for (char& c : text)
        if ((c >= 0 && c < 0x20) || c == 0x7F)
            c = ' ';
    return text;
}

Result<HeaderBlock> decodeHeaderBlock(ByteSpan bytes) {
    if (bytes.size() < 4 || std::memcmp(bytes.data(), "LASF", 4) != 0)
        return headerError(ErrorCode::corrupt, "this is no LAS file: it does not begin with \"LASF\"", 0);
    if (bytes.size() < minHeaderBlockSize)
        return headerError(ErrorCode::truncated,
                           cat("the header ends after ", bytes.size(), " of ", minHeaderBlockSize, " bytes"),
                           bytes.size(), "the file was cut off; copy it again");
    HeaderBlock block;
    ByteReader reader(bytes);
    reader.skip(4);
    block.fileSourceId = reader.read<std::uint16_t>();
    block.globalEncoding = reader.read<std::uint16_t>();
    for (std::uint8_t& byte : block.projectId)
        byte = reader.read<std::uint8_t>();
    block.versionMajor = reader.read<std::uint8_t>();
    block.versionMinor = reader.read<std::uint8_t>();
    if (block.versionMajor != 1 || block.versionMinor > 4)
        return headerError(ErrorCode::unsupported,
                           cat("LAS version ", block.versionMajor, ".", block.versionMinor, " is not known"),
                           24, "versions 1.0 to 1.4 are read");
    block.systemIdentifier = readableText(reader.readFixedText(32));
    block.generatingSoftware = readableText(reader.readFixedText(32));
    block.creationDay = reader.read<std::uint16_t>();
    block.creationYear = reader.read<std::uint16_t>();
    block.headerSize = reader.read<std::uint16_t>();
    if (block.headerSize < minHeaderBlockSize)
        return headerError(
            ErrorCode::corrupt,
            cat("the header size is given as ", block.headerSize, ", the smallest is ", minHeaderBlockSize),
            94);
    block.pointDataOffset = reader.read<std::uint32_t>();
    block.vlrCount = reader.read<std::uint32_t>();
    block.pointFormatByte = reader.read<std::uint8_t>();
    block.recordLength = reader.read<std::uint16_t>();
    block.legacyPointCount = reader.read<std::uint32_t>();
    for (std::uint32_t& count : block.legacyPointsByReturn)
        count = reader.read<std::uint32_t>();
    block.scale = readVec3d(reader);
    block.offset = readVec3d(reader);
    for (int axis = 0; axis < 3; ++axis) {
        block.bounds.max[axis] = reader.read<double>();
        block.bounds.min[axis] = reader.read<double>();
    }
    decodeLongFields(reader, block);
    if (!reader.ok())
        return headerError(ErrorCode::truncated,
                           cat("the header ends after ", bytes.size(), " of ",
                               headerBlockSize(block.versionMinor), " bytes"),
                           bytes.size(), "the file was cut off; copy it again");
    return block;
}

Bytes encodeHeaderBlock(const HeaderBlock& block) {
    ByteWriter writer;
    writer.writeFixedText("LASF", 4);
    writer.write(block.fileSourceId);
    writer.write(block.globalEncoding);
    writer.writeBytes(block.projectId);
    writer.write(block.versionMajor);
    writer.write(block.versionMinor);
    writer.writeFixedText(block.systemIdentifier, 32);
    writer.writeFixedText(block.generatingSoftware, 32);
    writer.write(block.creationDay);
    writer.write(block.creationYear);
    writer.write(block.headerSize);
    writer.write(block.pointDataOffset);
    writer.write(block.vlrCount);
    writer.write(block.pointFormatByte);
    writer.write(block.recordLength);
    writer.write(block.legacyPointCount);
    for (std::uint32_t count : block.legacyPointsByReturn)
        writer.write(count);
    for (int axis = 0; axis < 3; ++axis)
        writer.write(block.scale[axis]);
    for (int axis = 0; axis < 3; ++axis)
        writer.write(block.offset[axis]);
    for (int axis = 0; axis < 3; ++axis) {
        writer.write(block.bounds.max[axis]);
        writer.write(block.bounds.min[axis]);
    }
    writer.write(block.waveformOffset);
    writer.write(block.evlrOffset);
    writer.write(block.evlrCount);
    writer.write(block.pointCount);
    for (std::uint64_t count : block.pointsByReturn)
        writer.write(count);
    const Bytes& all = writer.bytes(); // as LAS 1.4 has it; earlier versions end before
    return Bytes(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(headerBlockSize(block.versionMinor)));
}

} // namespace stipple::las
