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

#include <array>

namespace stipple::server {

std::span<const Endpoint> endpoints() {
    static constexpr std::array table{
        Endpoint{"/clouds", answerClouds, cloudListParameters},
        Endpoint{"/clouds/{id}", answerCloud},
        Endpoint{"/clouds/{id}/hierarchy/{key}", answerHierarchy, hierarchyParameters},
        Endpoint{"/clouds/{id}/image", answerImage, imageParameters},
        Endpoint{"/clouds/{id}/nodes", answerBatch, batchParameters},
        Endpoint{"/clouds/{id}/nodes/{key}", answerNode, nodeParameters},
        Endpoint{"/clouds/{id}/points", answerPoints, pointsParameters},
        Endpoint{"/clouds/{id}/profile", answerProfile, profileParameters},
        Endpoint{"/clouds/{id}/nearest", answerNearest, nearestParameters},
        Endpoint{"/problems/{name}", answerProblemType},
    };
    return table;
}

} // namespace stipple::server
