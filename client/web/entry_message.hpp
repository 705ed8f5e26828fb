// A node's entry in a message between the page and a worker, without the place of its children.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/format/node_entry.hpp"

namespace stipple::web {

void writeKey(ByteWriter& out, const NodeKey& key);
NodeKey readKey(ByteReader& in);

void writeEntry(ByteWriter& out, const NodeEntry& entry);
// False where the message names more than it holds.
bool readEntry(ByteReader& in, NodeEntry& entry);

} // namespace stipple::web
