#include "server/site/cloud_version.hpp"

#include "server/files/open_file_source.hpp"
#include "shared/base/text.hpp"
#include "shared/format/block_frame.hpp"

namespace stipple::server {

namespace {

constexpr std::uint64_t maxMetadataBytes = 64ull << 20;

Result<Bytes> readPart(ByteSource& source, ByteRange range, const std::string& what) {
    if (range.size > maxMetadataBytes)
        return Error{ErrorCode::limitExceeded, cat("the ", what, " is larger than 64 MiB"), "", ""};
    STIPPLE_TRY(bytes, readNow(source, range));
    if (bytes.size() < range.size)
        return Error{ErrorCode::truncated, cat("the file ends inside its ", what), "",
                     "make one with `stipple convert SCAN -o NAME.stipple`"};
    return std::move(bytes);
}

Status readParts(ByteSource& source, CloudVersion& version) {
    STIPPLE_TRY(head, readPart(source, {0, fileHeaderBytes}, "header"));
    STIPPLE_TRY(header, parseFileHeader(head));
    if (header.fileBytes != source.sizeBytes())
        return Error{ErrorCode::truncated,
                     cat("the file has ", source.sizeBytes(), " bytes, its header says ", header.fileBytes),
                     "", "copy or convert it again"};
    STIPPLE_TRY(block, readPart(source, header.metadata, "metadata"));
    STIPPLE_TRY(metadata, parseMetadata(block));
    STIPPLE_TRY(text, unframeBlock(block, "metadata", header.metadata.offset));
    version.header = header;
    version.metadata = std::move(metadata);
    version.metadataText.assign(text.begin(), text.end());
    return {};
}

} // namespace

Result<std::shared_ptr<const CloudVersion>> readCloud(CloudVersion version, const std::string& name) {
    auto source = version.openSource();
    if (Status status = readParts(*source, version); !status)
        return status.error().where.starts_with(name) ? status.error() : status.error().at(name);
    return std::make_shared<const CloudVersion>(std::move(version));
}

Result<std::shared_ptr<const CloudVersion>> readCloud(std::shared_ptr<const OpenFile> file,
                                                      const std::string& name) {
    CloudVersion version;
    version.validators = {file->identity().entityTag(), file->identity().modifiedSeconds()};
    version.openSource = [file, name] { return sourceOver(file, name); };
    version.file = std::move(file);
    return readCloud(std::move(version), name);
}

} // namespace stipple::server
