// Why a cloud can't be had right now, as a response.
#pragma once

#include "server/http/message.hpp"
#include "shared/base/result.hpp"

namespace stipple::server {

// `error` as CloudCatalog::current() gives it: 404 for an id that there is not, 503 where the file is being
// replaced, cut, or no cloud any more.
HttpResponse cloudProblem(const Error& error);

} // namespace stipple::server
