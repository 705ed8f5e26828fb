// The binary section of a scan's records (ASTM E2807-11 §9.3): a header, then packets one after the other.
//
//   data packet    flags, and of each field of the record some bytes of its stream
//   index packet   where records begin; not needed, as fields are of fixed width
//   empty packet   to be ignored
//
// A field's stream is the bytes that the data packets have of it, joined; records may straddle packets, and
// one field's stream may run ahead of another's. A packet flagged "compressor restart" begins all streams
// anew at a whole record.
#pragma once

#include "converter/input/e57/document.hpp"
#include "converter/input/e57/paged_file.hpp"

namespace stipple::e57 {

enum class PacketType : std::uint8_t { index = 0, data = 1, empty = 2 };

struct Packet {
    PacketType type = PacketType::empty;
    bool restarts = false;
    std::uint64_t begin = 0, end = 0; // logical
    std::uint64_t payload = 0;        // logical offset of the first stream's bytes
    Bytes lengths;                    // of data packets: of each stream, 16 bits each

    std::uint64_t length(std::size_t field) const {
        return loadLe<std::uint16_t>(lengths.data() + 2 * field);
    }
};

// A run of records that can be read without those before.
struct RecordSpan {
    std::uint64_t firstRecord = 0, count = 0;
    std::uint64_t skipped = 0;         // records between the streams' (re)start and firstRecord
    std::uint64_t packet = 0;          // logical offset of a packet; no byte of the run lies in one before
    std::vector<std::uint64_t> before; // of each stream: its bytes between its (re)start and that packet
};

struct Section {
    std::uint64_t end = 0;         // logical
    std::vector<RecordSpan> spans; // in the records' order
};

// Walks over the packets' headers until they hold all records of `scan`, and divides these into runs of
// about `recordsPerSpan`. `file` should have small blocks: most of the file is stepped over. Errors:
// `corrupt` and `truncated`, with the byte, where packets contradict the file or hold too few records.
Result<Section> readSection(PagedFile& file, const FileHeader& header, const ScanEntry& scan,
                            std::uint64_t recordsPerSpan);

// One field's stream within a span, walking forward.
class StreamCursor {
  public:
    StreamCursor(PagedFile& file, const Section& section, const RecordSpan& span, std::size_t field,
                 std::size_t fieldCount);

    // Fills `out` with the stream's bytes from `begin` on (counted from its (re)start), not before those
    // that were read last.
    Status read(std::uint64_t begin, std::span<std::uint8_t> out);

  private:
    Status step(); // to the next data packet

    PagedFile& file_;
    std::uint64_t sectionEnd_;
    std::size_t field_, fieldCount_;
    Packet packet_;             // the current one; packet_.end is where the next begins
    std::uint64_t payload_ = 0; // logical offset of the stream's bytes in it
    std::uint64_t payloadBytes_ = 0;
    std::uint64_t before_; // bytes of the stream before it
};

} // namespace stipple::e57
