#include "server/api/hierarchy_endpoint.hpp"

#include "server/api/node_request.hpp"
#include "server/http/problem.hpp"
#include "shared/base/text.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace stipple::server {

namespace {

using Json = nlohmann::ordered_json;

Json vectorJson(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

Json cubeJson(const CloudMetadata& metadata, const NodeKey& key) {
    Vec3i min = metadata.rootCube.nodeMin(key);
    std::int64_t side = std::int64_t{1} << metadata.rootCube.nodeBits(key.level);
    return {{"min", vectorJson(metadata.grid.toWorld(min))},
            {"max", vectorJson(metadata.grid.toWorld(min + Vec3i{side, side, side}))}};
}

Json rangeJson(const ByteRange& range) {
    if (range.size == 0)
        return nullptr;
    return {{"offset", range.offset}, {"size", range.size}};
}

Json nodeJson(const CloudMetadata& metadata, const NodeEntry& entry) {
    return {{"key", entry.key.text()},
            {"childMask", entry.childMask},
            {"pointCount", entry.pointCount},
            {"bounds", cubeJson(metadata, entry.key)},
            {"spacing", std::ldexp(metadata.spacing, -entry.key.level)},
            {"offset", entry.offsetBytes},
            {"strataBytes", entry.strataBytes},
            {"attributeBytes", entry.attributeBytes},
            {"childChunk", rangeJson(entry.childChunk)}};
}

Json blocksJson(const CloudMetadata& metadata) {
    Json blocks = Json::array();
    for (const AttributeBlock& block : attributeBlocks(metadata)) {
        Json names = Json::array();
        for (int attribute : block.attributes)
            names.push_back(metadata.schema.attributes[static_cast<std::size_t>(attribute)].name);
        blocks.push_back(std::move(names));
    }
    return blocks;
}

Result<std::string> hierarchyJson(const CloudVersion& cloud, const std::string& id, const NodeKey& key,
                                  const std::vector<NodeEntry>& entries) {
    Json nodes = Json::array();
    for (const NodeEntry& entry : entries) {
        if (cloud.metadata.rootCube.nodeBits(entry.key.level) < 0)
            return Error{ErrorCode::corrupt, cat("node ", entry.key.text(), " is smaller than a grid step"),
                         "", ""};
        nodes.push_back(nodeJson(cloud.metadata, entry));
    }
    Json json{{"id", id},
              {"version", cloud.version()},
              {"key", key.text()},
              {"attributeBlocks", blocksJson(cloud.metadata)},
              {"nodes", std::move(nodes)}};
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace

Answer answerHierarchy(const ApiCall& call) {
    auto key = nodeKeyOf(call);
    if (!key)
        return parameterProblem(key.error());
    Validity validity = validityOf(call, cat("hierarchy ", key->text()));
    auto work = [cloud = call.cloud, id = call.id, key = *key, validity,
                 &cache = call.resources.hierarchy](AnswerWriter& writer) -> Status {
        auto source = cloud->openSource();
        STIPPLE_TRY(entries, cache.below(*cloud, *source, key, writer.isStopped()));
        if (validity.conditional) {
            writer.answer(*validity.conditional);
            return {};
        }
        STIPPLE_TRY(text, hierarchyJson(*cloud, id, key, entries));
        HttpResponse response;
        response.set("Content-Type", "application/json");
        validity.setFields(response);
        response.body.push_back(std::move(text));
        writer.answer(std::move(response));
        return {};
    };
    return Job{"hierarchy", std::move(work)};
}

} // namespace stipple::server
