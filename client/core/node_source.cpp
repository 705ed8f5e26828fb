#include "client/core/node_source.hpp"

#include "shared/base/text.hpp"
#include "shared/format/cloud_file.hpp"

#include <algorithm>

namespace stipple {

void FetchedRanges::add(std::uint64_t offset, Bytes bytes) {
    parts_.push_back({offset, std::move(bytes)});
}

std::uint64_t FetchedRanges::headBytes(ByteRange range) const {
    std::uint64_t most = 0;
    for (const Part& part : parts_)
        if (range.offset >= part.offset && range.offset - part.offset < part.bytes.size())
            most = std::max(most, part.bytes.size() - (range.offset - part.offset));
    return std::min(most, range.size);
}

std::optional<ByteSpan> FetchedRanges::find(ByteRange range) const {
    for (const Part& part : parts_) {
        if (range.offset < part.offset)
            continue;
        std::uint64_t skip = range.offset - part.offset;
        if (skip <= part.bytes.size() && range.size <= part.bytes.size() - skip)
            return ByteSpan(part.bytes)
                .subspan(static_cast<std::size_t>(skip), static_cast<std::size_t>(range.size));
    }
    return std::nullopt;
}

std::uint64_t FetchedRanges::sizeBytes() const {
    std::uint64_t sum = 0;
    for (const Part& part : parts_)
        sum += part.bytes.size();
    return sum;
}

namespace {

class StippleNodeSource final : public NodeSource {
  public:
    Result<OpenStep> open(const FetchedRanges& fetched) const override {
        ByteRange first{0, firstRequestBytes};
        std::uint64_t here = fetched.headBytes(first);
        if (here == 0)
            return OpenStep(first);
        STIPPLE_TRY(header, parseFileHeader(*fetched.find({0, here})));
        for (ByteRange needed : {header.metadata, header.rootChunk}) {
            STIPPLE_CHECK(checkInside(needed, header.fileBytes));
            if (!fetched.find(needed))
                return OpenStep(needed);
        }
        STIPPLE_TRY(metadata, parseMetadata(*fetched.find(header.metadata)));
        STIPPLE_CHECK(checkVersion(header, metadata));
        OpenedCloud cloud;
        cloud.fileBytes = header.fileBytes;
        cloud.metadataBlock = header.metadata;
        cloud.metadata = std::make_shared<const CloudMetadata>(std::move(metadata));
        STIPPLE_TRY(nodes, parseChunk(cloud, *fetched.find(header.rootChunk)));
        cloud.rootNodes = std::move(nodes);
        return OpenStep(std::move(cloud));
    }

    Result<std::vector<NodeEntry>> parseChunk(const OpenedCloud& cloud, ByteSpan block) const override {
        return parseHierarchyChunk(*cloud.metadata, cloud.fileBytes, block);
    }

  private:
    static Status checkInside(ByteRange range, std::uint64_t fileBytes) {
        if (range.offset > fileBytes || range.size > fileBytes - range.offset)
            return Error{ErrorCode::corrupt,
                         say("the header names bytes ", range.offset, " to ", range.end(), " of a file of ",
                             fileBytes),
                         "header", ""};
        return {};
    }
};

} // namespace

std::unique_ptr<NodeSource> makeStippleNodeSource() {
    return std::make_unique<StippleNodeSource>();
}

} // namespace stipple
