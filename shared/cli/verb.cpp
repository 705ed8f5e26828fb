#include "shared/cli/verb.hpp"

#include <cstdio>

namespace stipple::cli {

int exitCodeOf(const Error& error) {
    switch (error.code) {
    case ErrorCode::invalidArgument:
        return usageError;
    case ErrorCode::writeFailed:
    case ErrorCode::outOfMemory:
        return outputError;
    case ErrorCode::networkFailed:
    case ErrorCode::accessDenied:
        return networkError;
    case ErrorCode::cancelled:
        return interrupted;
    default:
        return inputError;
    }
}

int fail(const char* verb, const Error& error) {
    std::fprintf(stderr, "stipple %s: %s\n", verb, error.sentence().c_str());
    return exitCodeOf(error);
}

} // namespace stipple::cli
