// Whom an https client believes: the certificates that servers' own must rest on. Loaded once, shared by any
// number of connections. Thread: any.
#pragma once

#include "shared/base/result.hpp"

#include <boost/asio/ssl/context.hpp>
#include <memory>
#include <string>

namespace stipple {

class TlsTrust {
  public:
    // `caPath`: PEM file of the certificates to believe, and of no others; empty: those of the system
    // (OpenSSL's default places, or SSL_CERT_FILE and SSL_CERT_DIR). Errors: notFound, ioFailed,
    // invalidArgument (holds no certificate).
    static Result<std::shared_ptr<TlsTrust>> load(const std::string& caPath = "");

    // TLS 1.2 at least; a server whose certificate can't be verified is refused.
    boost::asio::ssl::context& context() { return context_; }

  private:
    TlsTrust() = default;
    boost::asio::ssl::context context_{boost::asio::ssl::context::tls_client};
};

} // namespace stipple
