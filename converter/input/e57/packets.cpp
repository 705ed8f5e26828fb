#include "converter/input/e57/packets.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <limits>

namespace stipple::e57 {

namespace {
constexpr const char* damaged = "the file is damaged, or was not written completely";
constexpr std::uint8_t compressedVectorSection = 1;
constexpr std::uint64_t sectionHeaderBytes = 32;
constexpr std::uint64_t packetAlignment = 4;
constexpr std::uint64_t dataHeaderBytes = 6; // before the streams' lengths
constexpr std::uint8_t restartFlag = 1;
constexpr std::uint64_t paddingBits = 64; // a stream may be filled up to a word of this width
// A record without bits takes no bytes, so nothing but this bounds a claim of such.
constexpr std::uint64_t maxBitlessRecords = std::uint64_t{1} << 24;

Error corruptPacket(std::uint64_t at, const std::string& what) {
    return {ErrorCode::corrupt, what, placeOf(at), damaged};
}

Status readDataHeader(PagedFile& file, std::size_t fieldCount, Packet& packet) {
    std::uint8_t bytes[2];
    STIPPLE_CHECK(file.read(packet.begin + 4, bytes));
    auto streams = loadLe<std::uint16_t>(bytes);
    if (streams != fieldCount)
        return corruptPacket(packet.begin, cat("the packet has ", streams, " byte streams, but a record has ",
                                               fieldCount, " fields"));
    packet.lengths.resize(2 * fieldCount);
    STIPPLE_CHECK(file.read(packet.begin + dataHeaderBytes, packet.lengths));
    packet.payload = packet.begin + dataHeaderBytes + packet.lengths.size();
    std::uint64_t end = packet.payload;
    for (std::size_t field = 0; field < fieldCount; ++field)
        end += packet.length(field);
    if (end > packet.end)
        return corruptPacket(packet.begin, cat("the packet's streams take ", end - packet.begin,
                                               " bytes, but the packet has ", packet.end - packet.begin));
    return {};
}

// The packet at `at`; reuses `packet`.
Status readPacket(PagedFile& file, std::uint64_t at, std::uint64_t sectionEnd, std::size_t fieldCount,
                  Packet& packet) {
    if (at + packetAlignment > sectionEnd)
        return Error{ErrorCode::truncated, "the packets end before the scan's last record", placeOf(at),
                     damaged};
    std::uint8_t bytes[4];
    STIPPLE_CHECK(file.read(at, bytes));
    if (bytes[0] > static_cast<std::uint8_t>(PacketType::empty))
        return corruptPacket(at, cat("there is no packet of type ", int{bytes[0]}));
    packet.type = static_cast<PacketType>(bytes[0]);
    packet.begin = at;
    packet.end = at + loadLe<std::uint16_t>(bytes + 2) + 1;
    if ((packet.end - at) % packetAlignment != 0)
        return corruptPacket(at, cat("the packet's length ", packet.end - at, " is no multiple of 4"));
    if (packet.end > sectionEnd)
        return Error{ErrorCode::truncated, "the packet ends behind its section", placeOf(at), damaged};
    if (packet.type != PacketType::data)
        return {};
    packet.restarts = (bytes[1] & restartFlag) != 0;
    return readDataHeader(file, fieldCount, packet);
}

// Follows the streams' lengths from packet to packet and notes where spans can be entered.
class Walk {
  public:
    Walk(const ScanEntry& scan, std::uint64_t recordsPerSpan, std::uint64_t firstPacket)
        : scan_(scan), recordsPerSpan_(recordsPerSpan), bytes_(scan.fields.size()) {
        begin(0, firstPacket);
    }

    bool isComplete() const { return chunkFirst_ + available() == scan_.recordCount; }
    std::uint64_t recordsSoFar() const { return chunkFirst_ + available(); }

    Status take(const Packet& packet) {
        if (packet.restarts && std::any_of(bytes_.begin(), bytes_.end(), [](auto b) { return b > 0; }))
            STIPPLE_CHECK(restart(packet.begin));
        while (!startsBefore(nextFirst_))
            cut();
        candidate_ = packet.begin;
        candidateBefore_ = bytes_;
        for (std::size_t f = 0; f < bytes_.size(); ++f)
            bytes_[f] += packet.length(f);
        return {};
    }

    // All spans, once complete.
    std::vector<RecordSpan> finish() {
        endChunk(scan_.recordCount);
        return std::move(spans_);
    }

  private:
    // Whole records that all streams have since their last (re)start.
    std::uint64_t available() const {
        std::uint64_t records = scan_.recordCount - chunkFirst_;
        for (std::size_t f = 0; f < bytes_.size(); ++f)
            if (int bits = scan_.fields[f].bits; bits > 0)
                records = std::min(records, 8 * bytes_[f] / static_cast<std::uint64_t>(bits));
        return records;
    }

    // Whether what the streams have so far ends before record `record`.
    bool startsBefore(std::uint64_t record) const {
        std::uint64_t skipped = record - chunkFirst_;
        for (std::size_t f = 0; f < bytes_.size(); ++f)
            if (auto bits = static_cast<std::uint64_t>(scan_.fields[f].bits);
                bits > 0 && bytes_[f] > skipped / 8 * bits + skipped % 8 * bits / 8)
                return false;
        return true;
    }

    // Streams (re)start at `record`, in `packet`.
    void begin(std::uint64_t record, std::uint64_t packet) {
        std::fill(bytes_.begin(), bytes_.end(), std::uint64_t{0});
        chunkFirst_ = record;
        open_ = {record, 0, 0, packet, bytes_};
        nextFirst_ = record + recordsPerSpan_;
        candidate_ = packet;
        candidateBefore_ = bytes_;
    }

    // Ends the open span at nextFirst_ and opens the next at the last packet it can be entered at.
    void cut() {
        open_.count = nextFirst_ - open_.firstRecord;
        spans_.push_back(open_);
        open_ = {nextFirst_, 0, nextFirst_ - chunkFirst_, candidate_, candidateBefore_};
        nextFirst_ += recordsPerSpan_;
    }

    void endChunk(std::uint64_t record) {
        while (nextFirst_ < record)
            cut();
        open_.count = record - open_.firstRecord;
        if (open_.count > 0)
            spans_.push_back(open_);
    }

    Status restart(std::uint64_t packet) {
        std::uint64_t records = available();
        for (std::size_t f = 0; f < bytes_.size(); ++f)
            if (auto bits = static_cast<std::uint64_t>(scan_.fields[f].bits);
                bits > 0 && 8 * bytes_[f] - records * bits >= paddingBits)
                return corruptPacket(packet, "the packet begins the streams anew, but they end at "
                                             "different records");
        endChunk(chunkFirst_ + records);
        begin(chunkFirst_ + records, packet);
        return {};
    }

    const ScanEntry& scan_;
    std::uint64_t recordsPerSpan_;
    std::vector<std::uint64_t> bytes_; // that each stream has so far since its (re)start
    std::uint64_t chunkFirst_ = 0;     // record at which they (re)started
    RecordSpan open_;                  // the span that is being walked over, its count to come
    std::uint64_t nextFirst_ = 0;      // first record of the span after it
    // The last packet at which that one can be entered.
    std::uint64_t candidate_ = 0;
    std::vector<std::uint64_t> candidateBefore_;
    std::vector<RecordSpan> spans_;
};

Status checkRecords(const ScanEntry& scan, std::uint64_t at) {
    bool bitless =
        std::all_of(scan.fields.begin(), scan.fields.end(), [](const Field& f) { return f.bits == 0; });
    if (bitless && scan.recordCount > maxBitlessRecords)
        return Error{ErrorCode::limitExceeded,
                     cat("the scan claims ", scan.recordCount, " records of no bytes at all; up to ",
                         maxBitlessRecords, " such are read"),
                     placeOf(at), ""};
    // Positions in bits are counted in 64 bits.
    if (scan.recordCount > std::numeric_limits<std::uint64_t>::max() / 128)
        return corruptPacket(at,
                             cat("the scan claims ", scan.recordCount, " records, which no file can hold"));
    return {};
}
} // namespace

Result<Section> readSection(PagedFile& file, const FileHeader& header, const ScanEntry& scan,
                            std::uint64_t recordsPerSpan) {
    Section section;
    if (scan.recordCount == 0)
        return section;
    STIPPLE_TRY(at, logicalOffset(scan.fileOffset, header, "the binary section"));
    STIPPLE_CHECK(checkRecords(scan, at));
    std::uint8_t bytes[sectionHeaderBytes];
    STIPPLE_CHECK(file.read(at, bytes));
    ByteReader reader(bytes);
    auto kind = reader.read<std::uint8_t>();
    reader.skip(7);
    auto length = reader.read<std::uint64_t>();
    auto dataOffset = reader.read<std::uint64_t>();
    if (kind != compressedVectorSection)
        return corruptPacket(at, cat("the points' binary section is of kind ", int{kind}, ", not 1"));
    section.end = at + std::min(length, file.sizeBytes() - at);
    STIPPLE_TRY(data, logicalOffset(dataOffset, header, "the first data packet"));
    Walk walk(scan, recordsPerSpan, data);
    Packet packet;
    for (std::uint64_t next = data; !walk.isComplete(); next = packet.end) {
        if (Status read = readPacket(file, next, section.end, scan.fields.size(), packet); !read) {
            Error error = read.error();
            error.what += cat(" (after ", walk.recordsSoFar(), " of ", scan.recordCount, " records)");
            return error;
        }
        if (packet.type == PacketType::data)
            STIPPLE_CHECK(walk.take(packet));
    }
    section.spans = walk.finish();
    return section;
}

StreamCursor::StreamCursor(PagedFile& file, const Section& section, const RecordSpan& span, std::size_t field,
                           std::size_t fieldCount)
    : file_(file), sectionEnd_(section.end), field_(field), fieldCount_(fieldCount),
      before_(span.before[field]) {
    packet_.end = span.packet;
}

Status StreamCursor::step() {
    before_ += payloadBytes_;
    payloadBytes_ = 0;
    do
        STIPPLE_CHECK(readPacket(file_, packet_.end, sectionEnd_, fieldCount_, packet_));
    while (packet_.type != PacketType::data);
    payload_ = packet_.payload;
    for (std::size_t f = 0; f < field_; ++f)
        payload_ += packet_.length(f);
    payloadBytes_ = packet_.length(field_);
    return {};
}

Status StreamCursor::read(std::uint64_t begin, std::span<std::uint8_t> out) {
    while (!out.empty()) {
        if (begin >= before_ + payloadBytes_) {
            STIPPLE_CHECK(step());
            continue;
        }
        std::uint64_t skip = begin - before_;
        std::size_t size =
            static_cast<std::size_t>(std::min<std::uint64_t>(out.size(), payloadBytes_ - skip));
        STIPPLE_CHECK(file_.read(payload_ + skip, out.first(size)));
        out = out.subspan(size);
        begin += size;
    }
    return {};
}

} // namespace stipple::e57
