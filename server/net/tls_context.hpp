// A certificate and its key, ready for handshakes: TLS 1.2 and 1.3, forward-secret authenticated ciphers,
// ALPN "http/1.1". Thread: any; const after loading. Connections keep the one that they began with.
#pragma once

#include "shared/base/result.hpp"

#include <memory>
#include <string>

struct ssl_ctx_st; // OpenSSL's SSL_CTX
struct ssl_st;     // SSL

namespace stipple::server {

class TlsContext {
  public:
    // PEM files: the certificate with those that lead to a known authority, the server's own first; its
    // private key, not encrypted. Errors: notFound, ioFailed (can't be read); invalidArgument (no
    // certificate, no key, an encrypted one, or one that does not belong to the certificate).
    static Result<std::shared_ptr<const TlsContext>> load(const std::string& certificatePath,
                                                          const std::string& keyPath);
    ~TlsContext();
    TlsContext(const TlsContext&) = delete;
    TlsContext& operator=(const TlsContext&) = delete;

    // For one accepted connection; null when memory is out. To be freed with SSL_free().
    ssl_st* newSession() const;

  private:
    explicit TlsContext(ssl_ctx_st* context) : context_(context) {}
    ssl_ctx_st* context_;
};

} // namespace stipple::server
