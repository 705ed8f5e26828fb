#include "server/api/api.hpp"
#include "server/api/cloud_endpoints.hpp"

#include <array>

namespace stipple::server {

std::span<const Endpoint> endpoints() {
    static constexpr std::array table{
        Endpoint{"/clouds", answerClouds},
        Endpoint{"/clouds/{id}", answerCloud},
        Endpoint{"/problems/{name}", answerProblemType},
    };
    return table;
}

} // namespace stipple::server
