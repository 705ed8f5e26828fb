#include "shared/base/text.hpp"
#include "shared/codec/progressive_order.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/format/picture_attributes.hpp"

#include <deque>

namespace stipple {

namespace {

class Reader final : public CloudReader {
  public:
    explicit Reader(ByteSource& source) : source_(source) {}

    Status open() {
        STIPPLE_TRY(start, readNow(source_, {0, fileHeaderBytes}));
        auto header = parseFileHeader(start);
        if (!header)
            return header.error().at(source_.name());
        header_ = *header;
        if (std::uint64_t size = source_.sizeBytes(); size > 0 && size != header_.fileBytes)
            return Error{size < header_.fileBytes ? ErrorCode::truncated : ErrorCode::corrupt,
                         cat("the file has ", size, " bytes instead of ", header_.fileBytes), source_.name(),
                         "the copy is incomplete or altered; copy it again"};
        STIPPLE_TRY(block, readNow(source_, header_.metadata));
        auto metadata = parseMetadata(block);
        if (!metadata)
            return metadata.error().at(source_.name());
        metadata_ = std::move(*metadata);
        blocks_ = attributeBlocks(metadata_);
        return {};
    }

    const FileHeader& header() const override { return header_; }
    const CloudMetadata& metadata() const override { return metadata_; }

    Status visitNodes(const std::function<Status(const NodeEntry&)>& visit) override {
        // A chunk is deeper than the one that names it, so a file whose chunks name each other in a circle
        // ends at the deepest level; the limit is for one that repeats itself sideways.
        std::deque<Wanted> wanted{{header_.rootChunk, NodeKey{}, 0}};
        std::uint64_t chunkBytes = 0;
        while (!wanted.empty()) {
            Wanted next = wanted.front();
            wanted.pop_front();
            chunkBytes += next.chunk.size;
            if (chunkBytes > header_.fileBytes)
                return Error{ErrorCode::corrupt, "the hierarchy chunks overlap", source_.name(), {}};
            STIPPLE_TRY(nodes, readChunk(next));
            for (const NodeEntry& node : nodes) {
                STIPPLE_CHECK(visit(node));
                if (node.childChunk.size > 0)
                    wanted.push_back({node.childChunk, node.key, node.childMask});
            }
        }
        return {};
    }

    Result<PointBatch> readNode(const NodeEntry& entry) override {
        ByteRange all{entry.offsetBytes, entry.sizeBytes()};
        STIPPLE_TRY(bytes, readNow(source_, all));
        auto points = decode(entry, bytes);
        if (!points)
            return points.error().at(source_.name());
        return points;
    }

  private:
    struct Wanted {
        ByteRange chunk;
        NodeKey parent;
        std::uint8_t childMask; // 0: the root chunk
    };

    Result<std::vector<NodeEntry>> readChunk(const Wanted& wanted) {
        std::string where = cat(source_.name(), ", byte ", wanted.chunk.offset);
        STIPPLE_TRY(block, readNow(source_, wanted.chunk));
        auto nodes = parseHierarchyChunk(metadata_, header_.fileBytes, block);
        if (!nodes)
            return nodes.error().at(where);
        bool expected = wanted.childMask == 0 ? !nodes->empty() && nodes->front().key == NodeKey{}
                                              : holdsChildren(*nodes, wanted.parent, wanted.childMask);
        if (!expected)
            return Error{ErrorCode::corrupt, "the hierarchy chunk is about other nodes", where, {}};
        return nodes;
    }

    static bool holdsChildren(const std::vector<NodeEntry>& nodes, const NodeKey& parent, std::uint8_t mask) {
        std::size_t at = 0;
        for (int c = 0; c < 8; ++c)
            if ((mask >> c) & 1) {
                if (at >= nodes.size() || nodes[at].key != parent.child(c))
                    return false;
                ++at;
            }
        return true;
    }

    Result<PointBatch> decode(const NodeEntry& entry, ByteSpan bytes) {
        auto partOf = [&](ByteRange range) {
            auto from = std::min<std::uint64_t>(range.offset - entry.offsetBytes, bytes.size());
            auto size = std::min<std::uint64_t>(range.size, bytes.size() - from);
            return bytes.subspan(static_cast<std::size_t>(from), static_cast<std::size_t>(size));
        };
        STIPPLE_TRY(picture,
                    decodePicture(metadata_, entry, strataCount, partOf(entry.strataRange(strataCount))));
        PointBatch points;
        Vec3i corner = entry.pointCount > 0 ? metadata_.rootCube.nodeMin(entry.key) : Vec3i{};
        points.positions.reserve(picture.size());
        for (const auto& p : picture.positions)
            points.positions.push_back(corner + Vec3i{p.x, p.y, p.z});
        points.columns.resize(metadata_.schema.attributes.size());
        std::vector<int> colour = pictureAttributes(metadata_);
        for (std::size_t c = 0; c < colour.size(); ++c) {
            Bytes& column = points.columns[static_cast<std::size_t>(colour[c])];
            column.resize(2 * picture.size());
            for (std::size_t i = 0; i < picture.size(); ++i)
                storeLe(column.data() + 2 * i, picture.colour[i * colour.size() + c]);
        }
        for (std::size_t b = 0; b < blocks_.size(); ++b) {
            STIPPLE_TRY(columns, decodeAttributes(metadata_, entry, b, partOf(entry.attributeRange(b))));
            for (std::size_t i = 0; i < columns.size(); ++i)
                points.columns[static_cast<std::size_t>(blocks_[b].attributes[i])] = std::move(columns[i]);
        }
        return points;
    }

    ByteSource& source_;
    FileHeader header_;
    CloudMetadata metadata_;
    std::vector<AttributeBlock> blocks_;
};

} // namespace

Result<std::unique_ptr<CloudReader>> CloudReader::open(ByteSource& source) {
    auto reader = std::make_unique<Reader>(source);
    STIPPLE_CHECK(reader->open());
    return std::unique_ptr<CloudReader>(std::move(reader));
}

} // namespace stipple
