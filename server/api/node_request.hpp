// Which node, and how much of it, a request asks for.
#pragma once

#include "server/api/endpoint.hpp"
#include "shared/base/result.hpp"
#include "shared/format/node_entry.hpp"
#include "shared/io/byte_source.hpp"

#include <string>
#include <vector>

namespace stipple::server {

inline constexpr Parameter strataParameter{
    .name = "strata",
    .description =
        "How many of a node's four strata: an eighth, a quarter, a half or all of its points, each spread "
        "evenly over the node.",
    .kind = ParameterKind::count,
    .least = 1,
    .most = strataCount,
    .example = "2",
    .usual = "4",
};
inline constexpr Parameter attributesParameter{
    .name = "attributes",
    .description =
        "Names of attributes, joined by commas; \"none\": positions alone. All if not given. In "
        "stored form: the blocks that hold them (the colour of the picture is part of the strata).",
    .example = "none",
};

// The key in the path of a call, its second name. invalidArgument, naming the parameter "key".
Result<NodeKey> nodeKeyOf(const ApiCall& call);

// What attributesParameter asks for: indices into the schema, in the order asked for. invalidArgument, naming
// the parameter.
Result<std::vector<int>> attributesOf(const Query& query, const Schema& schema);

struct NodePart {
    int strata = strataCount;
    std::vector<int> attributes; // indices into metadata.schema.attributes, in the order asked for
    std::string text() const;    // one form for all ways of asking for the same: "4 0 1 5"
};
// invalidArgument, naming the parameter.
Result<NodePart> nodePartOf(const ApiCall& call);

// The stored bytes of that part of a node: its strata and the blocks that hold the attributes, in the order
// of the file, as few ranges as can be.
std::vector<ByteRange> storedRanges(const CloudMetadata& metadata, const NodeEntry& entry,
                                    const NodePart& part);

} // namespace stipple::server
