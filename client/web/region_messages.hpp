// What travels beside a node's bytes from the viewer to the worker that makes something of a region: its
// entry, and whether its points are tested. Both ends are this program (decode_messages.hpp).
#pragma once

#include "client/core/region_request.hpp"
#include "shared/base/bytes.hpp"

namespace stipple::web {

Bytes encodeRegionNode(const RegionNode& node);
// Without bytes and attributes.
Result<RegionNode> decodeRegionNode(ByteSpan message);

} // namespace stipple::web
