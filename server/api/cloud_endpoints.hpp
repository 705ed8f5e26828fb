// What a cloud says about itself, and what problem documents mean. Answered at once.
#pragma once

#include "server/api/endpoint.hpp"

namespace stipple::server {

Answer answerCloud(const ApiCall& call);       // /clouds/{id}
Answer answerProblemType(const ApiCall& call); // /problems/{name}

} // namespace stipple::server
