// /clouds/{id}/statistics: of the whole cloud, told by its file without reading points where that is enough;
// else, and of the points that the query chooses as for /points, computed from them. What would have to read
// more points than ApiLimits allow is refused before it begins.
#pragma once

#include "server/api/endpoint.hpp"

namespace stipple::server {

Answer answerStatistics(const ApiCall& call);

} // namespace stipple::server
