#include "shared/base/result.hpp"

namespace stipple {

const char* errorCodeName(ErrorCode code) {
    switch (code) {
    case ErrorCode::invalidArgument:
        return "invalidArgument";
    case ErrorCode::notFound:
        return "notFound";
    case ErrorCode::changed:
        return "changed";
    case ErrorCode::truncated:
        return "truncated";
    case ErrorCode::corrupt:
        return "corrupt";
    case ErrorCode::unsupported:
        return "unsupported";
    case ErrorCode::limitExceeded:
        return "limitExceeded";
    case ErrorCode::outOfMemory:
        return "outOfMemory";
    case ErrorCode::outOfRange:
        return "outOfRange";
    case ErrorCode::ioFailed:
        return "ioFailed";
    case ErrorCode::writeFailed:
        return "writeFailed";
    case ErrorCode::networkFailed:
        return "networkFailed";
    case ErrorCode::accessDenied:
        return "accessDenied";
    case ErrorCode::cancelled:
        return "cancelled";
    }
    return "unknown";
}

} // namespace stipple
