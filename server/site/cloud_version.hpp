// One version of one cloud, wherever its bytes are: all that answers are made of. Immutable; who holds one
// reads these very bytes, also after the cloud has been replaced. Thread: any.
#pragma once

#include "server/files/open_file.hpp"
#include "server/http/preconditions.hpp"
#include "shared/base/result.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/byte_source.hpp"

#include <functional>
#include <memory>
#include <string>

namespace stipple::server {

class UpstreamVersion;

struct CloudVersion {
    FileHeader header;
    CloudMetadata metadata;
    std::string metadataText; // the file's own JSON document
    Validators validators;    // the tag differs between any two versions of any cloud
    // A source for one thread, which may wait inside read(); `changed` once the bytes are no longer these.
    std::function<std::unique_ptr<ByteSource>()> openSource;
    std::shared_ptr<const OpenFile> file; // for sending from the file directly; null: the bytes are elsewhere
    std::shared_ptr<UpstreamVersion> upstream; // where that is; null with a file

    std::uint64_t sizeBytes() const { return header.fileBytes; }
    // The tag without its quotes: what addresses of immutable answers name ("?version=").
    std::string version() const {
        const std::string& tag = validators.etag;
        std::size_t begin = tag.starts_with("W/") ? 3 : 1;
        return tag.size() <= begin ? tag : tag.substr(begin, tag.size() - begin - 1);
    }
};

// Reads header and metadata through `openSource`; waits. Memory: the metadata's size, at most 64 MiB.
// Errors: truncated, corrupt, unsupported (no cloud); those of the source. `name` is for messages.
Result<std::shared_ptr<const CloudVersion>> readCloud(CloudVersion version, const std::string& name);
// Of a file.
Result<std::shared_ptr<const CloudVersion>> readCloud(std::shared_ptr<const OpenFile> file,
                                                      const std::string& name);

} // namespace stipple::server
