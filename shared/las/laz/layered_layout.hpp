// Where the items of a layered chunk lie in a record, and how they follow the scanner channels.
#pragma once

#include "shared/las/laz/chunk_codec.hpp"
#include "shared/las/laz/layered_items.hpp"

namespace stipple::las::laz {

// Bytes of the record that a layer decides, of each byte the bits in `mask`.
struct LayerField {
    std::size_t offsetBytes = 0, sizeBytes = 0;
    std::uint8_t mask = 0xFF;
};

struct LayeredLayout {
    std::size_t recordLength = 0;
    ItemPlace colour, infrared, wavePacket, extraBytes;

    // All layers in the order of the chunk.
    std::vector<LayerField> fields() const;
};

// Errors: unsupported.
Result<LayeredLayout> layeredLayout(const Items& items);

} // namespace stipple::las::laz
