// The points of a node, decoded, as a file of some format.
#pragma once

#include "server/api/node_request.hpp"
#include "server/http/negotiation.hpp"
#include "server/site/cloud_version.hpp"
#include "shared/base/work_gate.hpp"

#include <string>

namespace stipple::server {

// Nodes have some ten thousand points; one of more than this (equal points can't be parted) is answered as
// stored or by some of its strata only: what is made here is made in memory, some 200 bytes a point.
inline constexpr std::uint32_t maxDecodedPoints = 2'000'000;

struct NodeFile {
    const Format& format; // any but "stored"
    std::string cloudId;
};

// Reads that part of the node, decodes it and writes it. Errors: limitExceeded (more than maxDecodedPoints);
// those of reading, of decoding, and of the format; cancelled once the gate is closed.
Result<std::string> nodeFile(const NodeFile& file, const CloudVersion& cloud, const NodeEntry& entry,
                             const NodePart& part, ByteSource& source, const WorkGate& gate);

} // namespace stipple::server
