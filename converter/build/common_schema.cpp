#include "converter/build/common_schema.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace stipple {

namespace {
using namespace attribute_names;
constexpr std::array lasOrder = {intensity,
                                 returnNumber,
                                 numberOfReturns,
                                 scanDirectionFlag,
                                 edgeOfFlightLine,
                                 classification,
                                 synthetic,
                                 keyPoint,
                                 withheld,
                                 overlap,
                                 scannerChannel,
                                 scanAngleRank,
                                 scanAngle,
                                 userData,
                                 pointSourceId,
                                 gpsTime,
                                 red,
                                 green,
                                 blue,
                                 nir,
                                 wavePacketDescriptorIndex,
                                 waveformDataOffset,
                                 waveformPacketSize,
                                 returnPointWaveformLocation,
                                 parametricDx,
                                 parametricDy,
                                 parametricDz};

std::size_t lasRank(std::string_view name) {
    return static_cast<std::size_t>(std::find(lasOrder.begin(), lasOrder.end(), name) - lasOrder.begin());
}

std::string typeText(const Attribute& attribute) {
    std::string text = attributeTypeName(attribute.type);
    return attribute.components > 1 ? cat(text, " x ", attribute.components) : text;
}
// What an attribute's stored values mean; attributes of one name and one meaning are merged.
std::string meaning(const Attribute& attribute) {
    std::string text = cat(typeText(attribute), ", scale ", attribute.scale, ", offset ", attribute.offset);
    return attribute.noData ? cat(text, ", no data ", *attribute.noData) : text;
}

using Variants = std::map<std::string, Attribute>; // meaning → the attribute as the cloud has it

// Description and unit say nothing about the stored value: of several the first by text is kept.
void keepText(std::string& kept, const std::string& text) {
    if (kept.empty() || (!text.empty() && text < kept))
        kept = text;
}

void nameVariants(const std::string& name, Variants& variants) {
    if (variants.size() == 1)
        return;
    std::map<std::string, int> perType;
    for (auto& [text, attribute] : variants)
        ++perType[typeText(attribute)];
    for (auto& [text, attribute] : variants) {
        bool typeTells = perType[typeText(attribute)] == 1;
        attribute.name = cat(name, " (", typeTells ? typeText(attribute) : text, ")");
    }
}
} // namespace

CommonSchema commonSchema(const std::vector<Schema>& inputs) {
    CommonSchema common;
    std::map<std::pair<std::size_t, std::string>, Variants> names; // (LAS rank, name) → variants
    bool same = true;
    for (const Schema& input : inputs) {
        same = same && input == inputs[0];
        for (const Attribute& attribute : input.attributes) {
            Variants& variants = names[{lasRank(attribute.name), attribute.name}];
            Attribute& kept = variants.try_emplace(meaning(attribute), attribute).first->second;
            keepText(kept.description, attribute.description);
            keepText(kept.unit, attribute.unit);
        }
    }
    std::map<std::pair<std::string, std::string>, int> indexOf; // (name, meaning) → attribute of the cloud
    auto add = [&](const std::string& name, const std::string& text, const Attribute& attribute) {
        indexOf[{name, text}] = static_cast<int>(common.schema.attributes.size());
        common.schema.attributes.push_back(attribute);
    };
    if (same && !inputs.empty()) {
        for (const Attribute& attribute : inputs[0].attributes)
            add(attribute.name, meaning(attribute), attribute);
    } else {
        for (auto& [rankAndName, variants] : names) {
            nameVariants(rankAndName.second, variants);
            for (const auto& [text, attribute] : variants)
                add(rankAndName.second, text, attribute);
        }
    }
    for (const Schema& input : inputs) {
        std::vector<int> sources(common.schema.attributes.size(), -1);
        for (std::size_t a = 0; a < input.attributes.size(); ++a) {
            const Attribute& attribute = input.attributes[a];
            sources[static_cast<std::size_t>(indexOf[{attribute.name, meaning(attribute)}])] =
                static_cast<int>(a);
        }
        common.sources.push_back(std::move(sources));
    }
    return common;
}

} // namespace stipple
