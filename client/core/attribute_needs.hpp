// Which bytes beside positions and picture colours a style needs of a cloud, and whether it needs the cloud
// at all.
#pragma once

#include "client/core/style.hpp"
#include "shared/format/cloud_metadata.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace stipple {

struct AttributeNeeds {
    // Indices of further blocks (NodeEntry::attributeRange), ascending: a node is drawn once they are here.
    std::vector<int> blocks;
    // The block of exact colours, if the style shows colours and inner nodes show means of them; -1: none.
    // Wanted of nodes whose children are all drawn.
    int exactBlock = -1;
    friend bool operator==(const AttributeNeeds&, const AttributeNeeds&) = default;
};
AttributeNeeds needsOf(const ColourStyle& style, const CloudMetadata& metadata);
// With the normals, where the style draws discs.
AttributeNeeds needsOf(const Style& style, const CloudMetadata& metadata);
// The same with every attribute of the cloud.
AttributeNeeds needsOfAll(const ColourStyle& style, const CloudMetadata& metadata);

// The cloud's statistics say that filters and hidden classes hide every point.
bool hidesAll(const ColourStyle& style, const CloudMetadata& metadata);

// What the style asks for that can't be shown of the cloud, and what is drawn instead: a sentence. Empty:
// nothing.
Phrase lackOf(const Style& style, const CloudMetadata& metadata, std::string_view cloudName);

// Bytes of a point's columns in the blocks of `needs`.
std::uint32_t columnBytes(const AttributeNeeds& needs, const CloudMetadata& metadata);

} // namespace stipple
