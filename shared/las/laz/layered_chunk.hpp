// Layered chunks of LASzip (compressor 3): point formats 6-10, items of version 3 or 4.
//
//   first point, raw │ u32 points │ u32 bytes of each layer │ layer 1 │ layer 2 │ …
//
// The layers: channel, returns, X and Y; Z; classification; flags; intensity; scan angle; user data; point
// source; GPS time; then of the items that the format has: RGB, near infrared, wave packet, one for each
// extra byte. A layer of no bytes repeats the first point's value.
#pragma once

#include "shared/las/laz/chunk_codec.hpp"

namespace stipple::las::laz {

// For POINT14 and then any of RGB14 or RGBNIR14, WAVEPACKET14 and BYTE14, in this order, of versions 3 and 4.
// Errors: unsupported.
//
// The decoder holds a few hundred KB for each scanner channel, and 2 KB for each extra byte that is not the
// same for all points of a chunk.
Result<std::unique_ptr<ChunkDecoder>> makeLayeredDecoder(const Items& items, const Layers& wanted);
// The encoder holds the bytes of the chunk besides.
Result<std::unique_ptr<ChunkEncoder>> makeLayeredEncoder(const Items& items);

} // namespace stipple::las::laz
