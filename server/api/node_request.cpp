#include "server/api/node_request.hpp"

#include "converter/export/filter_text.hpp"
#include "shared/base/text.hpp"
#include "shared/format/cloud_file.hpp"

#include <numeric>

namespace stipple::server {

Result<NodeKey> nodeKeyOf(const ApiCall& call) {
    if (auto key = nodeKeyFromText(call.names.at(1)))
        return *key;
    return parameterError("key", cat(quotedValue(call.names.at(1)), " is no key of a node"),
                          "write level-x-y-z, such as 0-0-0-0 for the root");
}

std::string NodePart::text() const {
    std::string text = cat(strata);
    for (int attribute : attributes)
        text += cat(" ", attribute);
    return text;
}

Result<std::vector<int>> attributesOf(const Query& query, const Schema& schema) {
    const std::string* names = query.find(attributesParameter.name);
    std::vector<int> attributes;
    if (!names) {
        attributes.resize(schema.attributes.size());
        std::iota(attributes.begin(), attributes.end(), 0);
    } else if (*names != "none" || schema.find("none") >= 0) {
        auto named = attributesFromTexts(schema, {*names});
        if (!named)
            return parameterError(attributesParameter.name, named.error().what, named.error().advice);
        attributes = std::move(*named);
    }
    return attributes;
}

Result<NodePart> nodePartOf(const ApiCall& call) {
    NodePart part;
    STIPPLE_TRY(strata, countOf(call.query, strataParameter));
    part.strata = static_cast<int>(strata.value_or(strataCount));
    STIPPLE_TRY(attributes, attributesOf(call.query, call.cloud->metadata.schema));
    part.attributes = std::move(attributes);
    return part;
}

std::vector<ByteRange> storedRanges(const CloudMetadata& metadata, const NodeEntry& entry,
                                    const NodePart& part) {
    std::vector<ByteRange> ranges{entry.strataRange(part.strata)};
    for (std::size_t block : blocksHolding(metadata, part.attributes)) {
        ByteRange range = entry.attributeRange(block);
        if (range.offset == ranges.back().end())
            ranges.back().size += range.size;
        else
            ranges.push_back(range);
    }
    std::erase_if(ranges, [](const ByteRange& range) { return range.size == 0; });
    return ranges;
}

} // namespace stipple::server
