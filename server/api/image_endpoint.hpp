// /clouds/{id}/image: a picture of the cloud, drawn by the software rasterizer as `stipple render` does, once
// everything that the view wants has been read. The same request gives the same bytes; its tag is known
// without drawing.
#pragma once

#include "server/api/endpoint.hpp"

namespace stipple::server {

Answer answerImage(const ApiCall& call);

} // namespace stipple::server
