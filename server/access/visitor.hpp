// What the sender of one request may read: the one place that decides it. Thread: any.
//
// Whoever may not read a cloud can't learn whether it exists: an absent cloud and a private one are refused
// in the same words (401 without credentials or with bad ones, 403 with a token for other clouds). So a
// server with private clouds answers 404 only to those who may know: with a token or signature for that id.
#pragma once

#include "server/access/access_rules.hpp"
#include "server/access/signed_address.hpp"
#include "server/http/message.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace stipple::server {

class Visitor {
  public:
    // Judges the credentials of `request`: its field Authorization, and the signature in `query` (that of its
    // target). `rules` null: everything is public.
    Visitor(std::shared_ptr<const AccessRules> rules, const HttpRequest& request, std::string_view query,
            std::int64_t nowSeconds);

    // Whether it may read the cloud, if there is one of this id. For lists.
    bool mayRead(std::string_view cloudId) const;

    // Nothing: it may read the cloud, or learn that there is none. Else the answer: 400, 401 or 403 with
    // WWW-Authenticate (RFC 6750 §3).
    std::optional<HttpResponse> refusal(std::string_view cloudId, bool exists) const;
    // The same for a list, which everybody may ask for, but not with bad credentials: somebody whose token
    // has expired must not take the public clouds for all there are.
    std::optional<HttpResponse> refusalOfList() const;

    // False: the answer is for everybody, and may be kept for everybody.
    bool isRestricted(std::string_view cloudId) const { return rules_ && rules_->isPrivate(cloudId); }
    bool seesAll() const { return !rules_ || !rules_->hidesAny(); }
    // The name of the token in use; empty: none.
    const std::string& name() const { return name_; }

  private:
    enum class Credentials { none, malformed, invalid, expired, token };
    bool isTrustedWith(std::string_view cloudId) const;
    HttpResponse refusalResponse() const;

    std::shared_ptr<const AccessRules> rules_;
    Credentials bearer_ = Credentials::none;
    const TokenRule* token_ = nullptr; // of rules_; if bearer_ is `token`
    AddressSignature signature_;
    std::int64_t nowSeconds_;
    std::string name_;
};

} // namespace stipple::server
