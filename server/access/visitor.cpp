#include "server/access/visitor.hpp"

#include "server/access/id_pattern.hpp"
#include "server/access/token.hpp"
#include "server/http/problem.hpp"
#include "shared/base/text.hpp"

namespace stipple::server {

namespace {

// RFC 6750 §3. `error` empty: the request brought nothing.
HttpResponse challenge(int status, const std::string& error, const std::string& description) {
    HttpResponse response = problemResponse(status, description);
    std::string value = "Bearer realm=\"stipple\"";
    if (!error.empty())
        value += cat(", error=\"", error, "\", error_description=\"", description, "\"");
    response.set("WWW-Authenticate", value);
    return response;
}

} // namespace

Visitor::Visitor(std::shared_ptr<const AccessRules> rules, const HttpRequest& request, std::string_view query,
                 std::int64_t nowSeconds)
    : rules_(std::move(rules)), nowSeconds_(nowSeconds) {
    if (!rules_)
        return;
    signature_ = parseAddressSignature(query);
    Bearer bearer = parseBearer(request.field("Authorization"), request.count("Authorization"));
    if (bearer.kind == BearerKind::malformed)
        bearer_ = Credentials::malformed;
    if (bearer.kind != BearerKind::token)
        return;
    token_ = findToken(*rules_, bearer.token);
    if (token_ == nullptr) {
        bearer_ = Credentials::invalid;
    } else if (token_->isExpired(nowSeconds)) {
        bearer_ = Credentials::expired;
    } else {
        bearer_ = Credentials::token;
        name_ = token_->name;
    }
}

bool Visitor::isTrustedWith(std::string_view cloudId) const {
    return (bearer_ == Credentials::token && matchesAny(token_->clouds, cloudId)) ||
           isValid(signature_, rules_->signingKey, cloudId, nowSeconds_);
}

bool Visitor::mayRead(std::string_view cloudId) const {
    return !isRestricted(cloudId) || isTrustedWith(cloudId);
}

std::optional<HttpResponse> Visitor::refusal(std::string_view cloudId, bool exists) const {
    if (seesAll() || (exists && !isRestricted(cloudId)) || isTrustedWith(cloudId))
        return std::nullopt;
    return refusalResponse();
}

std::optional<HttpResponse> Visitor::refusalOfList() const {
    if (seesAll() || bearer_ == Credentials::none || bearer_ == Credentials::token)
        return std::nullopt;
    return refusalResponse();
}

HttpResponse Visitor::refusalResponse() const {
    switch (bearer_) {
    case Credentials::malformed:
        return challenge(400, "invalid_request", "the field Authorization is malformed");
    case Credentials::invalid:
        return challenge(401, "invalid_token", "the token is not known");
    case Credentials::expired:
        return challenge(401, "invalid_token", "the token has expired");
    case Credentials::token:
        return challenge(403, "insufficient_scope", "the token is not for this cloud, or there is none");
    case Credentials::none:
        break;
    }
    if (signature_.isPresent)
        return challenge(401, "invalid_token", "the signature of the address is wrong or has expired");
    return challenge(401, "", "this cloud needs a token, or there is none");
}

} // namespace stipple::server
