#include "shared/base/text.hpp"
#include "shared/codec/progressive_order.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/format/picture_attributes.hpp"

#include <algorithm>
#include <deque>
#include <numeric>

namespace stipple {

namespace {

bool holdsChildren(const std::vector<NodeEntry>& nodes, const NodeKey& parent, std::uint8_t mask) {
    std::size_t at = 0;
    for (int c = 0; c < 8; ++c)
        if ((mask >> c) & 1) {
            if (at >= nodes.size() || nodes[at].key != parent.child(c))
                return false;
            ++at;
        }
    return true;
}

class Reader final : public CloudReader {
  public:
    explicit Reader(ByteSource& source) : source_(source) {}
    Reader(ByteSource& source, const FileHeader& header, CloudMetadata metadata)
        : source_(source), header_(header), metadata_(std::move(metadata)) {}

    Status open() {
        STIPPLE_TRY(start, readNow(source_, {0, fileHeaderBytes}));
        auto header = parseFileHeader(start);
        if (!header)
            return header.error().at(source_.name());
        header_ = *header;
        if (std::uint64_t size = source_.sizeBytes(); size > 0 && size != header_.fileBytes)
            return Error{size < header_.fileBytes ? ErrorCode::truncated : ErrorCode::corrupt,
                         say("the file has ", size, " bytes instead of ", header_.fileBytes), source_.name(),
                         say("the copy is incomplete or altered; copy it again")};
        STIPPLE_TRY(block, readNow(source_, header_.metadata));
        auto metadata = parseMetadata(block);
        if (!metadata)
            return metadata.error().at(source_.name());
        if (Status version = checkVersion(header_, *metadata); !version)
            return version.error().at(source_.name());
        metadata_ = std::move(*metadata);
        return {};
    }

    const FileHeader& header() const override { return header_; }
    const CloudMetadata& metadata() const override { return metadata_; }

    Result<HierarchyCounters> visitWanted(const std::function<Result<bool>(const NodeEntry&)>& visit,
                                          const bool* isEnough) override {
        // A chunk is deeper than the one that names it, so a file whose chunks name each other in a circle
        // ends at the deepest level; the limit is for one that repeats itself sideways.
        std::deque<ChunkPlace> wanted{rootChunkPlace(header_)};
        HierarchyCounters counters;
        auto skip = [&](const ByteRange& chunk) {
            ++counters.chunksSkipped;
            counters.bytesSkipped += chunk.size;
        };
        while (!wanted.empty()) {
            ChunkPlace next = wanted.front();
            wanted.pop_front();
            if (isEnough && *isEnough) {
                skip(next.range);
                continue;
            }
            ++counters.chunksRead;
            counters.bytesRead += next.range.size;
            if (counters.bytesRead > header_.fileBytes)
                return Error{ErrorCode::corrupt, say("the hierarchy chunks overlap"), source_.name(), {}};
            STIPPLE_TRY(nodes, readChunk(next));
            for (const NodeEntry& node : nodes) {
                if (isEnough && *isEnough)
                    break;
                STIPPLE_TRY(below, visit(node));
                if (node.childChunk.size == 0)
                    continue;
                if (below)
                    wanted.push_back(childChunkPlace(node));
                else
                    skip(node.childChunk);
            }
        }
        return counters;
    }

    Result<std::vector<NodeEntry>> readChunk(const ChunkPlace& place) override {
        return readHierarchyChunk(source_, header_, metadata_, place);
    }

    Result<NodeBytes> fetchNode(const NodeEntry& entry, std::span<const int> attributes) override {
        NodeBytes node{entry, {attributes.begin(), attributes.end()}, {}, strataCount};
        std::vector<ByteRange> ranges{entry.strataRange(strataCount)};
        for (std::size_t block : blocksHolding(metadata_, attributes)) {
            if (block >= entry.attributeBytes.size())
                return Error{ErrorCode::invalidArgument,
                             say("the cloud has no such block"),
                             "node " + entry.key.text(),
                             {}};
            ByteRange range = entry.attributeRange(block);
            if (range.offset == ranges.back().end())
                ranges.back().size += range.size; // neighbours are read at once
            else
                ranges.push_back(range);
        }
        for (const ByteRange& range : ranges) {
            if (range.size == 0)
                continue;
            STIPPLE_TRY(part, readNow(source_, range));
            if (node.bytes.empty())
                node.bytes = std::move(part);
            else
                node.bytes.insert(node.bytes.end(), part.begin(), part.end());
        }
        return node;
    }

  protected:
    std::string sourceName() const override { return source_.name(); }

  private:
    ByteSource& source_;
    FileHeader header_;
    CloudMetadata metadata_;
};

// Where the columns of the attributes asked for come from, as NodeBytes::attributes lists them.
std::vector<std::size_t> placesOf(const std::vector<int>& attributes, int wanted) {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < attributes.size(); ++i)
        if (attributes[i] == wanted)
            places.push_back(i);
    return places;
}

Status takeColour(const CloudMetadata& metadata, const NodeBytes& node, const NodePicture& picture,
                  const WorkGate* gate, PointBatch& points) {
    std::vector<int> colour = pictureAttributes(metadata);
    for (std::size_t c = 0; c < colour.size(); ++c)
        for (std::size_t place : placesOf(node.attributes, colour[c])) {
            Bytes& column = points.columns[place];
            column.resize(2 * picture.size());
            STIPPLE_CHECK(inPieces(gate, picture.size(), [&](std::size_t first, std::size_t end) {
                for (std::size_t i = first; i < end; ++i)
                    storeLe(column.data() + 2 * i, picture.colour[i * colour.size() + c]);
            }));
        }
    return {};
}

} // namespace

Result<std::vector<NodeEntry>> readHierarchyChunk(ByteSource& source, const FileHeader& header,
                                                  const CloudMetadata& metadata, const ChunkPlace& place) {
    std::string where = cat(source.name(), ", byte ", place.range.offset);
    STIPPLE_TRY(block, readNow(source, place.range));
    auto nodes = parseHierarchyChunk(metadata, header.fileBytes, block);
    if (!nodes)
        return nodes.error().at(where);
    bool expected = place.parentChildMask == 0 ? !nodes->empty() && nodes->front().key == NodeKey{}
                                               : holdsChildren(*nodes, place.parent, place.parentChildMask);
    if (!expected)
        return Error{ErrorCode::corrupt, say("the hierarchy chunk is about other nodes"), where, {}};
    return nodes;
}

std::vector<std::size_t> blocksHolding(const CloudMetadata& metadata, std::span<const int> attributes) {
    std::vector<AttributeBlock> all = attributeBlocks(metadata);
    std::vector<std::size_t> holding;
    for (std::size_t b = 0; b < all.size(); ++b)
        if (std::any_of(attributes.begin(), attributes.end(), [&](int attribute) {
                const std::vector<int>& held = all[b].attributes;
                return std::find(held.begin(), held.end(), attribute) != held.end();
            }))
            holding.push_back(b);
    return holding;
}

Result<PointBatch> decodeNode(const CloudMetadata& metadata, const NodeBytes& node, const WorkGate* gate) {
    const NodeEntry& entry = node.entry;
    std::size_t at = 0; // a block that is cut short is the decoder's to report
    auto next = [&](std::uint64_t size) {
        auto take = static_cast<std::size_t>(std::min<std::uint64_t>(size, node.bytes.size() - at));
        at += take;
        return ByteSpan(node.bytes).subspan(at - take, take);
    };
    STIPPLE_TRY(picture,
                decodePicture(metadata, entry, node.strata, next(entry.strataRange(node.strata).size), gate));
    PointBatch points;
    Vec3i corner = entry.pointCount > 0 ? metadata.rootCube.nodeMin(entry.key) : Vec3i{};
    points.positions.reserve(picture.size());
    STIPPLE_CHECK(inPieces(gate, picture.size(), [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
            const auto& p = picture.positions[i];
            points.positions.push_back(corner + Vec3i{p.x, p.y, p.z});
        }
    }));
    points.columns.resize(node.attributes.size());
    std::vector<AttributeBlock> blocks = attributeBlocks(metadata);
    for (std::size_t block : blocksHolding(metadata, node.attributes)) {
        std::uint64_t size = block < entry.attributeBytes.size() ? entry.attributeBytes[block] : 0;
        if (blocks[block].isExactColour) {
            STIPPLE_CHECK(decodeExactColour(metadata, entry, next(size), picture, gate));
            continue;
        }
        STIPPLE_TRY(columns, decodeAttributes(metadata, entry, block, next(size), gate));
        for (std::size_t i = 0; i < columns.size(); ++i) {
            auto attribute = static_cast<std::size_t>(blocks[block].attributes[i]);
            // A block is of all points of the node, in the same order.
            columns[i].resize(picture.size() * metadata.schema.attributes[attribute].size());
            std::vector<std::size_t> places = placesOf(node.attributes, blocks[block].attributes[i]);
            for (std::size_t p = 0; p < places.size(); ++p)
                points.columns[places[p]] = p + 1 < places.size() ? columns[i] : std::move(columns[i]);
        }
    }
    STIPPLE_CHECK(takeColour(metadata, node, picture, gate, points));
    return points;
}

Status CloudReader::visitNodes(const std::function<Status(const NodeEntry&)>& visit) {
    auto visited = visitWanted([&](const NodeEntry& entry) -> Result<bool> {
        STIPPLE_CHECK(visit(entry));
        return true;
    });
    return visited ? Status() : Status(visited.error());
}

Result<PointBatch> CloudReader::readNode(const NodeEntry& entry) {
    std::vector<int> all(metadata().schema.attributes.size());
    std::iota(all.begin(), all.end(), 0);
    STIPPLE_TRY(bytes, fetchNode(entry, all));
    auto points = decodeNode(metadata(), bytes);
    if (!points)
        return points.error().at(sourceName());
    return points;
}

std::unique_ptr<CloudReader> CloudReader::over(ByteSource& source, const FileHeader& header,
                                               CloudMetadata metadata) {
    return std::make_unique<Reader>(source, header, std::move(metadata));
}

Result<std::unique_ptr<CloudReader>> CloudReader::open(ByteSource& source) {
    auto reader = std::make_unique<Reader>(source);
    STIPPLE_CHECK(reader->open());
    return std::unique_ptr<CloudReader>(std::move(reader));
}

} // namespace stipple
