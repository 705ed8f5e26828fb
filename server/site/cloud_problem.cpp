#include "server/site/cloud_problem.hpp"

#include "server/http/problem.hpp"

namespace stipple::server {

HttpResponse cloudProblem(const Error& error) {
    switch (error.code) {
    case ErrorCode::notFound:
        return problemResponse({problem_types::noSuchCloud, "there is no cloud of this id"});
    case ErrorCode::truncated:
    case ErrorCode::corrupt:
    case ErrorCode::unsupported:
    case ErrorCode::networkFailed:
    case ErrorCode::accessDenied:
    case ErrorCode::changed:
    case ErrorCode::cancelled:
        return jobProblem(error);
    default:
        return problemResponse(error);
    }
}

} // namespace stipple::server
