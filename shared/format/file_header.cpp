#include "shared/base/text.hpp"
#include "shared/codec/checksum.hpp"
#include "shared/format/file_parts.hpp"

#include <algorithm>
#include <array>

namespace stipple {

namespace {
// As PNG's: a byte no text has, then a name, then line ends and a control byte that careless copies change.
constexpr std::array<std::uint8_t, 8> magic{0x89, 'S', 'T', 'P', 'L', '\r', '\n', 0x1A};
constexpr std::size_t checksumOffset = fileHeaderBytes - 4;

Error inHeader(ErrorCode code, Phrase what, std::size_t byte, Phrase advice = {}) {
    return Error{code, std::move(what), cat("header, byte ", byte), std::move(advice)};
}
} // namespace

Bytes writeFileHeader(const FileHeader& header) {
    ByteWriter to;
    to.writeBytes(magic);
    to.write(header.version);
    to.write(static_cast<std::uint32_t>(fileHeaderBytes));
    to.write(header.fileBytes);
    to.write(header.metadata.offset);
    to.write(header.metadata.size);
    to.write(header.rootChunk.offset);
    to.write(header.rootChunk.size);
    to.write<std::uint32_t>(0);
    to.write(blockChecksum(to.bytes()));
    return to.take();
}

Result<FileHeader> parseFileHeader(ByteSpan bytes) {
    std::size_t known = std::min(bytes.size(), magic.size());
    if (!std::equal(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(known), magic.begin()))
        return inHeader(ErrorCode::unsupported, say("this is no .stipple file"), 0,
                        say("convert the scan with `stipple convert`"));
    if (bytes.size() < fileHeaderBytes)
        return inHeader(ErrorCode::truncated,
                        say("the header ends after ", bytes.size(), " of ", fileHeaderBytes, " bytes"),
                        bytes.size());
    ByteReader from(bytes.first(fileHeaderBytes));
    from.skip(magic.size());
    auto version = from.read<std::uint32_t>();
    if (version < 1 || version > latestVersion)
        return inHeader(ErrorCode::unsupported,
                        say("the file has format version ", version, "; this program reads versions 1 to ",
                            latestVersion),
                        8, say("use a newer program, or convert the scan again"));
    if (blockChecksum(bytes.first(checksumOffset)) != loadLe<std::uint32_t>(bytes.data() + checksumOffset))
        return inHeader(ErrorCode::corrupt, say("the checksum does not match the header"), checksumOffset,
                        say("the file was altered or damaged; copy or convert it again"));
    if (auto size = from.read<std::uint32_t>(); size != fileHeaderBytes)
        return inHeader(ErrorCode::corrupt, say("a header of ", size, " bytes"), 12);
    FileHeader header;
    header.version = version;
    header.fileBytes = from.read<std::uint64_t>();
    header.metadata = {from.read<std::uint64_t>(), 0};
    header.metadata.size = from.read<std::uint64_t>();
    header.rootChunk = {from.read<std::uint64_t>(), 0};
    header.rootChunk.size = from.read<std::uint64_t>();
    auto inside = [&](ByteRange range) {
        return range.offset >= fileHeaderBytes && range.offset <= header.fileBytes &&
               range.size <= header.fileBytes - range.offset;
    };
    if (!inside(header.metadata) || header.metadata.size > maxMetadataBytes)
        return inHeader(ErrorCode::corrupt, say("the metadata lie outside the file"), 24);
    if (!inside(header.rootChunk) || header.rootChunk.size > maxChunkBytes)
        return inHeader(ErrorCode::corrupt, say("the root hierarchy chunk lies outside the file"), 40);
    return header;
}

Status checkVersion(const FileHeader& header, const CloudMetadata& metadata) {
    if (std::uint32_t needed = versionFor(metadata); header.version < needed)
        return inHeader(ErrorCode::corrupt,
                        say("format version ", header.version, ", but the metadata are of version ", needed),
                        8);
    return {};
}

} // namespace stipple
