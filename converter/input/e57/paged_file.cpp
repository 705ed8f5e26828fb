#include "converter/input/e57/paged_file.hpp"

#include "converter/input/e57/crc32c.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <cstdio>

namespace stipple::e57 {

namespace {
constexpr std::string_view signature = "ASTM-E57";
constexpr const char* damaged = "the file is damaged; copy it from its source again";

std::string hex(std::uint32_t value) {
    char text[16];
    std::snprintf(text, sizeof text, "%08X", static_cast<unsigned>(value));
    return text;
}

std::uint32_t storedChecksum(const std::uint8_t* page) {
    const std::uint8_t* at = page + pagePayloadBytes;
    return std::uint32_t{at[0]} << 24 | std::uint32_t{at[1]} << 16 | std::uint32_t{at[2]} << 8 | at[3];
}

Status checkPage(const std::uint8_t* page, std::uint64_t number) {
    std::uint32_t stated = storedChecksum(page), found = crc32c({page, pagePayloadBytes});
    if (stated == found)
        return {};
    return Error{
        ErrorCode::corrupt,
        cat("the checksum of page ", number, " is ", hex(stated), ", but its bytes give ", hex(found)),
        cat("byte ", number * pageBytes), damaged};
}

Status checkHeader(const FileHeader& header, std::uint64_t pageSize, std::uint64_t fileBytes) {
    if (header.versionMajor != 1)
        return Error{ErrorCode::unsupported,
                     cat("the file is of E57 version ", header.versionMajor, ".", header.versionMinor,
                         "; version 1 is read"),
                     "byte 8", "write it as E57 1.0"};
    if (pageSize != pageBytes)
        return Error{ErrorCode::unsupported,
                     cat("its pages are of ", pageSize, " bytes; E57 1.0 has pages of ", pageBytes),
                     "byte 40", ""};
    if (header.fileBytes > fileBytes)
        return Error{
            ErrorCode::truncated,
            cat("the file has ", fileBytes, " of the ", header.fileBytes, " bytes its header states"),
            "byte 16", "was it copied completely?"};
    if (header.fileBytes % pageBytes != 0)
        return Error{ErrorCode::corrupt,
                     cat("the header states ", header.fileBytes, " bytes, which is no number of whole pages"),
                     "byte 16", damaged};
    return {};
}
} // namespace

Result<FileHeader> readFileHeader(ByteSource& source) {
    STIPPLE_TRY(page, readNow(source, {0, pageBytes}));
    if (page.size() < pageBytes)
        return Error{ErrorCode::truncated,
                     cat("the file ends after ", page.size(), " bytes; its first page has ", pageBytes), "",
                     "was it copied completely?"};
    ByteReader reader(page);
    if (reader.readFixedText(signature.size()) != signature)
        return Error{ErrorCode::unsupported, "this is no E57 file: it does not begin with ASTM-E57", "byte 0",
                     ""};
    FileHeader header;
    header.versionMajor = reader.read<std::uint32_t>();
    header.versionMinor = reader.read<std::uint32_t>();
    header.fileBytes = reader.read<std::uint64_t>();
    header.xmlOffset = reader.read<std::uint64_t>();
    header.xmlBytes = reader.read<std::uint64_t>();
    auto pageSize = reader.read<std::uint64_t>();
    header.pageChecksum = storedChecksum(page.data());
    STIPPLE_CHECK(checkPage(page.data(), 0));
    STIPPLE_CHECK(checkHeader(header, pageSize, source.sizeBytes()));
    return header;
}

Result<std::uint64_t> logicalOffset(std::uint64_t physical, const FileHeader& header, const char* what) {
    if (physical >= header.fileBytes || physical % pageBytes >= pagePayloadBytes)
        return Error{ErrorCode::corrupt,
                     cat(what, " is said to be at byte ", physical,
                         physical >= header.fileBytes ? ", behind the file's end" : ", in a page's checksum"),
                     "", damaged};
    return physical / pageBytes * pagePayloadBytes + physical % pageBytes;
}

std::string placeOf(std::uint64_t logical) {
    return cat("byte ", physicalOffset(logical));
}

Status PagedFile::read(std::uint64_t logical, std::span<std::uint8_t> out) {
    if (logical > sizeBytes() || out.size() > sizeBytes() - logical)
        return Error{
            ErrorCode::truncated,
            cat(out.size(), " bytes are to be read here, but the file ends at byte ", pageCount_ * pageBytes),
            placeOf(logical), damaged};
    std::uint64_t blockBytes = pagesPerBlock_ * pagePayloadBytes;
    while (!out.empty()) {
        STIPPLE_TRY(from, block(logical / blockBytes));
        std::size_t begin = static_cast<std::size_t>(logical % blockBytes);
        std::size_t size = std::min(out.size(), from->bytes.size() - begin);
        std::copy_n(from->bytes.data() + begin, size, out.data());
        out = out.subspan(size);
        logical += size;
    }
    return {};
}

Result<const PagedFile::Block*> PagedFile::block(std::uint64_t number) {
    Block* oldest = &blocks_.front();
    for (Block& block : blocks_) {
        if (block.number == number) {
            block.lastUse = ++uses_;
            return &block;
        }
        if (block.lastUse < oldest->lastUse)
            oldest = &block;
    }
    std::uint64_t firstPage = number * pagesPerBlock_;
    std::uint64_t pages = std::min(pagesPerBlock_, pageCount_ - firstPage);
    oldest->number = ~std::uint64_t{0};
    STIPPLE_TRY(bytes, readNow(source_, {firstPage * pageBytes, pages * pageBytes}));
    if (bytes.size() != pages * pageBytes)
        return Error{ErrorCode::truncated, "the file became shorter while it was read",
                     cat("byte ", firstPage * pageBytes + bytes.size()), ""};
    for (std::uint64_t page = 0; page < pages; ++page) {
        STIPPLE_CHECK(checkPage(bytes.data() + page * pageBytes, firstPage + page));
        std::memmove(bytes.data() + page * pagePayloadBytes, bytes.data() + page * pageBytes,
                     pagePayloadBytes);
    }
    bytes.resize(static_cast<std::size_t>(pages * pagePayloadBytes));
    *oldest = {number, ++uses_, std::move(bytes)};
    return oldest;
}

} // namespace stipple::e57
