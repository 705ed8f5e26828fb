#include "client/headless/tls_trust.hpp"

#include "shared/base/text.hpp"

#include <cerrno>
#include <cstring>
#include <openssl/ssl.h>
#include <unistd.h>

namespace stipple {

namespace ssl = boost::asio::ssl;

Result<std::shared_ptr<TlsTrust>> TlsTrust::load(const std::string& caPath) {
    std::shared_ptr<TlsTrust> trust(new TlsTrust);
    SSL_CTX_set_min_proto_version(trust->context_.native_handle(), TLS1_2_VERSION);
    boost::system::error_code problem;
    trust->context_.set_verify_mode(ssl::verify_peer, problem);
    if (caPath.empty()) {
        trust->context_.set_default_verify_paths(problem);
    } else if (::access(caPath.c_str(), R_OK) != 0) {
        return Error{errno == ENOENT ? ErrorCode::notFound : ErrorCode::ioFailed,
                     cat("can't be read: ", std::strerror(errno)), caPath, ""};
    } else {
        trust->context_.load_verify_file(caPath, problem);
        if (problem)
            return Error{ErrorCode::invalidArgument, cat("holds no certificate (", problem.message(), ")"),
                         caPath, "PEM files are text that begins with -----BEGIN CERTIFICATE"};
    }
    if (problem)
        return Error{ErrorCode::ioFailed, cat("TLS can't be set up: ", problem.message()), caPath, ""};
    return trust;
}

} // namespace stipple
