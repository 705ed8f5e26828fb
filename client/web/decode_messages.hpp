// What travels between the viewer and its decoding workers besides the points themselves: a job and an
// answer, as bytes. Both ends are this program; lengths are checked all the same, so that a page that mixes
// two versions gets an error and not garbage.
#pragma once

#include "client/core/node_decoder.hpp"
#include "shared/base/bytes.hpp"

namespace stipple::web {

// Everything of a job but its metadata (workers keep that per cloud) and its bytes, which are sent beside it:
// first the picture, or what an exact colour is coded against; second the block of attributes.
Bytes encodeJob(const DecodeJob& job);
Result<DecodeJob> decodeJob(ByteSpan message);

// The arrays of a ResidentNode, in the order in which they travel beside an answer.
inline constexpr int nodeArrayCount = 4;
ByteSpan nodeArray(const ResidentNode& node, int index);
std::uint8_t* nodeArrayBytes(ResidentNode& node, int index);

// A node without the contents of its arrays, or an error.
Bytes encodeAnswer(const Result<ResidentNode>& answer);
// The same node with its arrays sized, to be filled; or the error.
Result<ResidentNode> decodeAnswer(ByteSpan message);

} // namespace stipple::web
