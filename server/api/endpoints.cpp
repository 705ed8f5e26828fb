#include "server/api/api.hpp"
#include "server/api/batch_endpoint.hpp"
#include "server/api/cloud_endpoints.hpp"
#include "server/api/cloud_list_endpoint.hpp"
#include "server/api/hierarchy_endpoint.hpp"
#include "server/api/image_endpoint.hpp"
#include "server/api/image_request.hpp"
#include "server/api/nearest_endpoint.hpp"
#include "server/api/node_endpoint.hpp"
#include "server/api/points_endpoint.hpp"
#include "server/api/points_parameters.hpp"
#include "server/api/statistics_endpoint.hpp"
#include "server/api/statistics_parameters.hpp"

#include <array>

namespace stipple::server {

namespace {
constexpr std::array json{jsonFormat};
constexpr std::array batch{batchFormat};
} // namespace

std::span<const Endpoint> endpoints() {
    static constexpr std::array table{
        Endpoint{.path = "/openapi.json",
                 .answer = answerOpenApi,
                 .name = "getDescription",
                 .summary = "This document",
                 .formats = json,
                 .schema = "OpenApi",
                 .isWork = false,
                 .hasRanges = true},
        Endpoint{.path = "/clouds",
                 .answer = answerClouds,
                 .name = "listClouds",
                 .summary = "The clouds that the client may read, page by page",
                 .parameters = cloudListParameters,
                 .formats = json,
                 .schema = "CloudList",
                 .hasRanges = true},
        Endpoint{.path = "/clouds/{id}",
                 .answer = answerCloud,
                 .name = "getCloud",
                 .summary = "A cloud with its metadata",
                 .formats = json,
                 .schema = "Cloud",
                 .isWork = false,
                 .hasRanges = true},
        Endpoint{.path = "/clouds/{id}/hierarchy/{key}",
                 .answer = answerHierarchy,
                 .name = "getHierarchy",
                 .summary = "A node and those below it, as far as one chunk of the file describes them",
                 .parameters = hierarchyParameters,
                 .formats = json,
                 .schema = "Hierarchy"},
        Endpoint{.path = "/clouds/{id}/image",
                 .answer = answerImage,
                 .name = "getImage",
                 .summary = "A picture of the cloud",
                 .parameters = imageParameters,
                 .formats = imageFormats,
                 .example = "view=top&width=320&height=200&budget=100000"},
        Endpoint{.path = "/clouds/{id}/nodes",
                 .answer = answerBatch,
                 .name = "getNodes",
                 .summary = "Several nodes as stored, in one answer",
                 .parameters = batchParameters,
                 .formats = batch,
                 .example = "keys=0-0-0-0,1-0-0-0:2"},
        Endpoint{.path = "/clouds/{id}/nodes/{key}",
                 .answer = answerNode,
                 .name = "getNode",
                 .summary = "The points of one node",
                 .parameters = nodeParameters,
                 .formats = nodeFormats,
                 .schema = "NodePoints",
                 .example = "format=json&strata=1"},
        Endpoint{.path = "/clouds/{id}/points",
                 .answer = answerPoints,
                 .name = "getPoints",
                 .summary = "All points that pass every condition given, as a file",
                 .parameters = pointsParameters,
                 .formats = pointFileFormats,
                 .example = "box=-1e7,-1e7,1e7,1e7&limit=100&format=csv"},
        Endpoint{.path = "/clouds/{id}/profile",
                 .answer = answerProfile,
                 .name = "getProfile",
                 .summary = "The points along a line, with their station and offset",
                 .parameters = profileParameters,
                 .formats = pointFileFormats,
                 .example = "line=-1e7,0;1e7,1&width=2e7&limit=100&format=csv"},
        Endpoint{.path = "/clouds/{id}/nearest",
                 .answer = answerNearest,
                 .name = "getNearest",
                 .summary = "The points nearest to a place, or the first along a ray",
                 .parameters = nearestParameters,
                 .formats = json,
                 .schema = "Nearest",
                 .example = "point=0,0,0&count=2"},
        Endpoint{.path = "/clouds/{id}/statistics",
                 .answer = answerStatistics,
                 .name = "getStatistics",
                 .summary = "How many points there are, where, and what values they have",
                 .parameters = statisticsParameters,
                 .formats = json,
                 .schema = "Statistics",
                 .example = "box=-1e7,-1e7,1e7,1e7&bins=10"},
        Endpoint{.path = "/problems/{name}",
                 .answer = answerProblemType,
                 .name = "getProblemType",
                 .summary = "What the type of a problem document means",
                 .formats = json,
                 .schema = "ProblemType",
                 .isWork = false,
                 .hasRanges = true},
    };
    return table;
}

} // namespace stipple::server
