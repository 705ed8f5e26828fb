// What a streamable format has to answer so that its clouds can be shown: how to open a file from its first
// bytes, and what a block of hierarchy says. Selection, loading and cache know no more of a format than
// this; COPC or EPT become two more implementations. (A format of many files maps ranges of one virtual
// address space to them in its byte source.)
//
// Pure: bytes in, answers out; no I/O, nothing waits. Safe on untrusted bytes.
#pragma once

#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/format/node_entry.hpp"

#include <memory>
#include <optional>
#include <variant>
#include <vector>

namespace stipple {

// Ranges of a file that were fetched, kept so that no byte is asked for twice.
class FetchedRanges {
  public:
    void add(std::uint64_t offset, Bytes bytes);
    // The bytes of `range` if one fetched range holds them all; borrowed until the next add().
    std::optional<ByteSpan> find(ByteRange range) const;
    // How many bytes from range.offset on are here, at most range.size.
    std::uint64_t headBytes(ByteRange range) const;
    std::uint64_t sizeBytes() const;

  private:
    struct Part {
        std::uint64_t offset;
        Bytes bytes;
    };
    std::vector<Part> parts_;
};

struct OpenedCloud {
    std::shared_ptr<const CloudMetadata> metadata;
    std::uint64_t fileBytes = 0;
    ByteRange metadataBlock;          // of what was fetched: what parseMetadata() took
    std::vector<NodeEntry> rootNodes; // of the first piece of the hierarchy, parents before children
};

// The range that must be fetched before opening can go on, or the opened cloud.
using OpenStep = std::variant<ByteRange, OpenedCloud>;

class NodeSource {
  public:
    virtual ~NodeSource() = default;

    // Called with what is here until it answers with the cloud or an error; what it asks for is added to
    // `fetched` in between. The first range may reach past the end of a small file.
    virtual Result<OpenStep> open(const FetchedRanges& fetched) const = 0;
    // The nodes of a further piece of the hierarchy (a node's childChunk), parents before children.
    virtual Result<std::vector<NodeEntry>> parseChunk(const OpenedCloud& cloud, ByteSpan block) const = 0;
};

// `.stipple` files: one request of firstRequestBytes is enough to open most of them.
std::unique_ptr<NodeSource> makeStippleNodeSource();

} // namespace stipple
