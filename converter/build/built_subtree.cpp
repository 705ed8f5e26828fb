#include "converter/build/built_subtree.hpp"

#include "shared/codec/checksum.hpp"

namespace stipple {

namespace {
// A record: u32 size, u64 XXH64 of the payload, payload. The payload's first byte says what it is.
constexpr std::size_t recordHead = sizeof(std::uint32_t) + sizeof(std::uint64_t);
enum class RecordKind : std::uint8_t { density = 1, subtree = 2 };

void writeKey(ByteWriter& to, const NodeKey& key) {
    to.write(key.level);
    to.write(key.x);
    to.write(key.y);
    to.write(key.z);
}
NodeKey readKey(ByteReader& from) {
    NodeKey key;
    key.level = from.read<std::uint8_t>();
    key.x = from.read<std::uint32_t>();
    key.y = from.read<std::uint32_t>();
    key.z = from.read<std::uint32_t>();
    return key;
}

void writeStatistics(ByteWriter& to, const BatchStatistics& statistics) {
    to.write(static_cast<std::uint32_t>(statistics.size()));
    for (const PartialStatistics& s : statistics) {
        to.write(s.count);
        to.write(s.min);
        to.write(s.max);
        to.write(s.mean);
        to.write(s.squares);
        to.write<std::uint8_t>(s.histogram.has_value());
        to.write(static_cast<std::uint32_t>(s.histogram ? s.histogram->size() : 0));
        if (s.histogram)
            for (const auto& [value, count] : *s.histogram) {
                to.write(value);
                to.write(count);
            }
    }
}
BatchStatistics readStatistics(ByteReader& from) {
    BatchStatistics statistics;
    auto attributes = from.read<std::uint32_t>();
    for (std::uint32_t a = 0; a < attributes && from.ok(); ++a) {
        PartialStatistics& s = statistics.emplace_back();
        s.count = from.read<std::uint64_t>();
        s.min = from.read<double>();
        s.max = from.read<double>();
        s.mean = from.read<double>();
        s.squares = from.read<double>();
        s.histogram.reset();
        if (from.read<std::uint8_t>() != 0)
            s.histogram.emplace();
        auto values = from.read<std::uint32_t>();
        for (std::uint32_t i = 0; i < values && from.ok(); ++i) {
            auto value = from.read<std::int64_t>();
            auto count = from.read<std::uint64_t>();
            if (s.histogram)
                s.histogram->emplace(value, count);
        }
    }
    return statistics;
}

void writeNodes(ByteWriter& to, const std::vector<StoredNode>& nodes) {
    to.write(static_cast<std::uint32_t>(nodes.size()));
    for (const StoredNode& node : nodes) {
        writeKey(to, node.key);
        to.write(node.pointCount);
        to.write(node.strataBytes);
        to.write(static_cast<std::uint32_t>(node.attributeBytes.size()));
        for (std::uint32_t bytes : node.attributeBytes)
            to.write(bytes);
        to.write(node.offset);
    }
}
std::vector<StoredNode> readNodes(ByteReader& from) {
    std::vector<StoredNode> nodes;
    auto count = from.read<std::uint32_t>();
    for (std::uint32_t i = 0; i < count && from.ok(); ++i) {
        StoredNode& node = nodes.emplace_back();
        node.key = readKey(from);
        node.pointCount = from.read<std::uint32_t>();
        node.strataBytes = from.read<std::array<std::uint32_t, strataCount>>();
        auto blocks = from.read<std::uint32_t>();
        for (std::uint32_t b = 0; b < blocks && from.ok(); ++b)
            node.attributeBytes.push_back(from.read<std::uint32_t>());
        node.offset = from.read<std::uint64_t>();
    }
    return nodes;
}

void writeBorders(ByteWriter& to, const Borders& borders) {
    to.write(static_cast<std::uint32_t>(borders.size()));
    for (const auto& [key, points] : borders) {
        writeKey(to, key);
        to.write(static_cast<std::uint32_t>(points.size()));
        for (Vec3i p : points)
            to.write(p);
    }
}
Borders readBorders(ByteReader& from) {
    Borders borders;
    auto count = from.read<std::uint32_t>();
    for (std::uint32_t i = 0; i < count && from.ok(); ++i) {
        std::vector<Vec3i>& points = borders[readKey(from)];
        auto size = from.read<std::uint32_t>();
        for (std::uint32_t p = 0; p < size && from.ok(); ++p)
            points.push_back(from.read<Vec3i>());
    }
    return borders;
}

Bytes subtreeRecord(const BuiltSubtree& subtree) {
    ByteWriter to;
    to.write(RecordKind::subtree);
    to.write(subtree.tier);
    writeKey(to, subtree.key);
    to.write(subtree.points);
    to.write(subtree.hash);
    writeStatistics(to, subtree.statistics);
    writeNodes(to, subtree.nodes);
    to.write(subtree.sampleOffset);
    to.write(subtree.samplePoints);
    writeBorders(to, subtree.borders);
    return to.take();
}

BuiltSubtree readSubtree(ByteReader& from) {
    BuiltSubtree subtree;
    subtree.tier = from.read<int>();
    subtree.key = readKey(from);
    subtree.points = from.read<std::uint64_t>();
    subtree.hash = from.read<PointHash>();
    subtree.statistics = readStatistics(from);
    subtree.nodes = readNodes(from);
    subtree.sampleOffset = from.read<std::uint64_t>();
    subtree.samplePoints = from.read<std::uint64_t>();
    subtree.borders = readBorders(from);
    return subtree;
}
} // namespace

Result<Journal> Journal::open(WorkFolder& folder, bool reopen) {
    STIPPLE_TRY(file, folder.scratch("journal", reopen));
    Journal journal(std::move(file));
    STIPPLE_CHECK(journal.load());
    return journal;
}

Status Journal::load() {
    std::uint64_t end = file_->end(), at = 0;
    while (at + recordHead <= end) {
        Bytes head(recordHead);
        STIPPLE_CHECK(file_->read(at, head));
        auto size = loadLe<std::uint32_t>(head.data());
        if (size > end - at - recordHead)
            break;
        Bytes payload(size);
        STIPPLE_CHECK(file_->read(at + recordHead, payload));
        if (xxh64(payload) != loadLe<std::uint64_t>(head.data() + sizeof(std::uint32_t)))
            break;
        ByteReader from(payload);
        auto kind = from.read<RecordKind>();
        if (kind == RecordKind::density)
            density_ = from.read<int>();
        else if (kind == RecordKind::subtree)
            built_.push_back(readSubtree(from));
        if (!from.ok())
            break;
        at += recordHead + size;
    }
    file_->setEnd(at);
    return {};
}

Status Journal::setDensity(int density) {
    density_ = density;
    ByteWriter record;
    record.write(RecordKind::density);
    record.write(density);
    return append(record.bytes());
}

Status Journal::add(const BuiltSubtree& subtree) {
    return append(subtreeRecord(subtree));
}

Status Journal::append(ByteSpan payload) {
    ByteWriter record;
    record.write(static_cast<std::uint32_t>(payload.size()));
    record.write(xxh64(payload));
    record.writeBytes(payload);
    // What could not be written is overwritten by the next: the list would end there.
    std::uint64_t at = file_->end();
    STIPPLE_CHECK(file_->write(at, record.bytes()));
    file_->setEnd(at + record.size());
    return {};
}

} // namespace stipple
