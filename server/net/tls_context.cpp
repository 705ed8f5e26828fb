#include "server/net/tls_context.hpp"

#include "shared/base/text.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <unistd.h>

namespace stipple::server {

namespace {

// Forward secrecy and authenticated encryption only; those of TLS 1.3 are all of that kind.
constexpr const char* tls12Ciphers = "ECDHE+AESGCM:ECDHE+CHACHA20";
constexpr const char* pemAdvice = "PEM files are text that begins with -----BEGIN";

Error openSslError(std::string what, const std::string& path, std::string advice) {
    unsigned long code = ERR_peek_last_error();
    ERR_clear_error();
    const char* reason = code != 0 ? ERR_reason_error_string(code) : nullptr;
    return {ErrorCode::invalidArgument, reason ? cat(what, " (", reason, ")") : std::move(what), path,
            std::move(advice)};
}

Status canBeRead(const std::string& path) {
    int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0)
        return Error{errno == ENOENT ? ErrorCode::notFound : ErrorCode::ioFailed,
                     cat("can't be opened: ", std::strerror(errno)), path, ""};
    ::close(descriptor);
    return {};
}

// Instead of OpenSSL's own, which asks at the terminal.
int noPassword(char*, int, int, void* wasAsked) {
    *static_cast<bool*>(wasAsked) = true;
    return -1;
}

Status useKey(SSL_CTX* context, const std::string& path) {
    bool isEncrypted = false;
    SSL_CTX_set_default_passwd_cb(context, noPassword);
    SSL_CTX_set_default_passwd_cb_userdata(context, &isEncrypted);
    int isRead = SSL_CTX_use_PrivateKey_file(context, path.c_str(), SSL_FILETYPE_PEM);
    SSL_CTX_set_default_passwd_cb_userdata(context, nullptr);
    if (isEncrypted) {
        ERR_clear_error();
        return Error{
            ErrorCode::invalidArgument, "the key is encrypted, and nobody is there to be asked", path,
            "decrypt it with `openssl pkey -in KEY -out PLAIN`, readable by the server's user alone"};
    }
    if (isRead == 1)
        return {};
    if (ERR_GET_REASON(ERR_peek_last_error()) == X509_R_KEY_VALUES_MISMATCH)
        return openSslError("the key does not belong to the certificate", path,
                            "give the two that were made together");
    return openSslError("holds no private key", path, pemAdvice);
}

// RFC 7301 §3.2: a client that offers only protocols that are not spoken here is told so.
int selectProtocol(SSL*, const unsigned char** chosen, unsigned char* chosenSize,
                   const unsigned char* offered, unsigned int offeredSize, void*) {
    static const unsigned char spoken[] = "\x08http/1.1\x08http/1.0";
    unsigned char* found = nullptr;
    if (SSL_select_next_proto(&found, chosenSize, spoken, sizeof spoken - 1, offered, offeredSize) !=
        OPENSSL_NPN_NEGOTIATED)
        return SSL_TLSEXT_ERR_ALERT_FATAL;
    *chosen = found;
    return SSL_TLSEXT_ERR_OK;
}

} // namespace

Result<std::shared_ptr<const TlsContext>> TlsContext::load(const std::string& certificatePath,
                                                           const std::string& keyPath) {
    STIPPLE_CHECK(canBeRead(certificatePath));
    STIPPLE_CHECK(canBeRead(keyPath));
    SSL_CTX* context = SSL_CTX_new(TLS_server_method());
    if (context == nullptr)
        return openSslError("TLS can't be set up", "", "");
    std::shared_ptr<const TlsContext> made(new TlsContext(context));

    SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION);
    SSL_CTX_set_cipher_list(context, tls12Ciphers);
    SSL_CTX_set_options(context, SSL_OP_NO_COMPRESSION | SSL_OP_NO_RENEGOTIATION);
    // Partial writes, as a socket has them; no buffers for connections that are idle.
    SSL_CTX_set_mode(context, SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER |
                                  SSL_MODE_RELEASE_BUFFERS);
    SSL_CTX_set_session_cache_mode(context, SSL_SESS_CACHE_OFF); // tickets resume without memory here
    SSL_CTX_set_alpn_select_cb(context, selectProtocol, nullptr);

    if (SSL_CTX_use_certificate_chain_file(context, certificatePath.c_str()) != 1)
        return openSslError("holds no certificate", certificatePath, pemAdvice);
    STIPPLE_CHECK(useKey(context, keyPath));
    if (SSL_CTX_check_private_key(context) != 1)
        return openSslError("the key does not belong to the certificate", keyPath,
                            "give the two that were made together");
    return made;
}

TlsContext::~TlsContext() {
    SSL_CTX_free(context_);
}

SSL* TlsContext::newSession() const {
    SSL* session = SSL_new(context_);
    if (session != nullptr)
        SSL_set_accept_state(session);
    return session;
}

} // namespace stipple::server
