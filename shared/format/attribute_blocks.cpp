#include "shared/format/picture_attributes.hpp"

#include <algorithm>
#include <array>

namespace stipple {

namespace {

namespace names = attribute_names;

// Attributes that are small and read together share a block.
const std::array<std::vector<std::string_view>, 3> families{{
    {names::returnNumber, names::numberOfReturns},
    {names::scanDirectionFlag, names::edgeOfFlightLine, names::synthetic, names::keyPoint, names::withheld,
     names::overlap, names::scannerChannel},
    {names::wavePacketDescriptorIndex, names::waveformDataOffset, names::waveformPacketSize,
     names::returnPointWaveformLocation, names::parametricDx, names::parametricDy, names::parametricDz},
}};

int familyOf(std::string_view name) {
    for (std::size_t f = 0; f < families.size(); ++f)
        if (std::find(families[f].begin(), families[f].end(), name) != families[f].end())
            return static_cast<int>(f);
    return -1;
}

} // namespace

std::vector<int> pictureAttributes(const CloudMetadata& metadata) {
    switch (metadata.pictureColour) {
    case PictureColour::rgb:
        return {metadata.schema.find(names::red), metadata.schema.find(names::green),
                metadata.schema.find(names::blue)};
    case PictureColour::intensity:
        return {metadata.schema.find(names::intensity)};
    case PictureColour::none:
        break;
    }
    return {};
}

Status checkPictureAttributes(const CloudMetadata& metadata) {
    for (int a : pictureAttributes(metadata)) {
        if (a < 0)
            return Error{ErrorCode::invalidArgument,
                         say("the cloud has no attributes for the colour of its picture"),
                         {},
                         {}};
        const Attribute& attribute = metadata.schema.attributes[static_cast<std::size_t>(a)];
        if (attribute.type != AttributeType::u16 || attribute.components != 1)
            return Error{
                ErrorCode::invalidArgument,
                say("the attribute \"", attribute.name, "\" has to be one uint16 to colour the picture"),
                {},
                {}};
    }
    return {};
}

std::vector<AttributeBlock> attributeBlocks(const CloudMetadata& metadata) {
    std::vector<int> taken = pictureAttributes(metadata);
    std::array<int, families.size()> blockOfFamily;
    blockOfFamily.fill(-1);
    std::vector<AttributeBlock> blocks;
    if (metadata.innerColour != InnerColour::exact && !taken.empty())
        blocks.push_back({taken, true});
    for (std::size_t a = 0; a < metadata.schema.attributes.size(); ++a) {
        if (std::find(taken.begin(), taken.end(), static_cast<int>(a)) != taken.end())
            continue;
        int family = familyOf(metadata.schema.attributes[a].name);
        if (family >= 0 && blockOfFamily[static_cast<std::size_t>(family)] >= 0) {
            blocks[static_cast<std::size_t>(blockOfFamily[static_cast<std::size_t>(family)])]
                .attributes.push_back(static_cast<int>(a));
            continue;
        }
        if (family >= 0)
            blockOfFamily[static_cast<std::size_t>(family)] = static_cast<int>(blocks.size());
        blocks.push_back({{static_cast<int>(a)}, false});
    }
    return blocks;
}

} // namespace stipple
