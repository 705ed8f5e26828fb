#include "shared/las/las_records.hpp"

#include "shared/base/text.hpp"

#include <algorithm>

namespace stipple::las {

namespace {

constexpr std::uint64_t windowBytes = 256 * 1024;

Vlr parseRecordHeader(ByteSpan bytes, bool extended) {
    Vlr vlr;
    vlr.extended = extended;
    ByteReader reader(bytes);
    reader.skip(2); // reserved, or the signature 0xAABB of LAS 1.0
    vlr.userId = readableText(reader.readFixedText(16));
    vlr.recordId = reader.read<std::uint16_t>();
    vlr.sizeBytes = extended ? reader.read<std::uint64_t>() : reader.read<std::uint16_t>();
    vlr.description = readableText(reader.readFixedText(32));
    return vlr;
}

} // namespace

Result<ByteSpan> WindowReader::at(std::uint64_t offset, std::uint64_t size) {
    if (size > fileBytes_ || offset > fileBytes_ - size)
        return Error{ErrorCode::truncated, cat("the file ends before byte ", offset, " + ", size),
                     cat("byte ", offset), ""};
    if (offset < windowOffset_ || offset + size > windowOffset_ + window_.size()) {
        std::uint64_t wanted = std::min(std::max(size, windowBytes), fileBytes_ - offset);
        STIPPLE_TRY(bytes, readNow(source_, {offset, wanted}));
        if (bytes.size() < size)
            return Error{ErrorCode::changed, "the file became shorter while it was read",
                         cat("byte ", offset), "open it again"};
        window_ = std::move(bytes);
        windowOffset_ = offset;
    }
    return ByteSpan(window_).subspan(static_cast<std::size_t>(offset - windowOffset_),
                                     static_cast<std::size_t>(size));
}

Result<std::uint64_t> readVlrs(WindowReader& file, std::uint64_t offset, std::uint64_t count,
                               std::uint64_t end, bool extended, RecordWalk& walk) {
    const char* kind = extended ? "extended variable length record " : "variable length record ";
    std::uint64_t headerSize = extended ? evlrHeaderSize : vlrHeaderSize;
    end = std::min(end, file.fileBytes());
    for (std::uint64_t i = 0; i < count; ++i) {
        if (offset > end || end - offset < headerSize) {
            walk.warnings.push_back(cat("byte ", offset, ": the header counts ", count,
                                        extended ? " extended" : "", " variable length records, but only ", i,
                                        " lie before ", end == file.fileBytes() ? "the end" : "the points"));
            break;
        }
        STIPPLE_TRY(head, file.at(offset, headerSize));
        Vlr vlr = parseRecordHeader(head, extended);
        vlr.offsetBytes = offset + headerSize;
        if (vlr.sizeBytes > end - vlr.offsetBytes) {
            walk.warnings.push_back(cat("byte ", offset, ": ", kind, i + 1, " of ", count, " claims ",
                                        vlr.sizeBytes, " bytes, but ",
                                        end == file.fileBytes() ? "the file ends" : "the points begin",
                                        " before; it and what follows are ignored"));
            break;
        }
        offset = vlr.offsetBytes + vlr.sizeBytes;
        if (walk.loadedBytes + sizeof(Vlr) > maxLoadedRecordBytes) {
            walk.warnings.push_back(cat("byte ", offset, ": more variable length records than fit ",
                                        maxLoadedRecordBytes >> 20, " MiB; the rest is ignored"));
            break;
        }
        walk.loadedBytes += sizeof(Vlr);
        vlr.omitted = vlr.is(records::spec, records::waveformPackets) ||
                      vlr.sizeBytes > maxLoadedRecordBytes - walk.loadedBytes;
        if (!vlr.omitted) {
            STIPPLE_TRY(data, file.at(vlr.offsetBytes, vlr.sizeBytes));
            vlr.data.assign(data.begin(), data.end());
            walk.loadedBytes += vlr.sizeBytes;
        }
        walk.vlrs.push_back(std::move(vlr));
    }
    return offset;
}

} // namespace stipple::las
