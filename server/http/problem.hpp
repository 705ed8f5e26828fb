// Errors as RFC 9457 problem documents (application/problem+json).
#pragma once

#include "server/http/message.hpp"
#include "shared/base/result.hpp"

#include <string>

namespace stipple::server {

// {"title": reason phrase, "status": …, "detail": …}; never cached.
HttpResponse problemResponse(int status, const std::string& detail);

// For an error met while opening what a path names: 404 where it is absent or no file, 503 where descriptors
// ran out, else 500. Paths of this machine do not appear in it.
HttpResponse problemResponse(const Error& error);

// 400 for a parameter of the query (server/api/query.hpp): detail is the error's sentence, and the extension
// member "parameter" names it where error.where does.
HttpResponse parameterProblem(const Error& error);

// 405 with Allow (RFC 9110 §15.5.6), or 501 for methods nobody knows.
HttpResponse methodNotAllowed(std::string_view method, const std::string& allow);

} // namespace stipple::server
