#include "server/api/validity.hpp"

#include "server/http/problem.hpp"
#include "server/http/representation.hpp"
#include "shared/base/text.hpp"

#include <cstdio>

namespace stipple::server {

namespace {

// 64-bit FNV-1a. The program's version is part of it: a new one may write the same points in another way.
std::string derivedTag(const CloudVersion& cloud, std::string_view variant) {
    std::uint64_t hash = 0xCBF29CE484222325ull;
    for (std::string_view text : {std::string_view(STIPPLE_VERSION "\n"), variant})
        for (char c : text)
            hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ull;
    char text[24];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return cat("\"", cloud.version(), ".", text, "\"");
}

} // namespace

void Validity::setFields(HttpResponse& response) const {
    setValidatorFields(response, validators, cacheControl);
    if (variesByAccept)
        response.addToList("Vary", "Accept");
}

Validity validityOf(const ApiCall& call, std::string_view variant, bool variesByAccept) {
    Validity validity;
    validity.validators.etag = derivedTag(*call.cloud, variant);
    bool isImmutable = call.query.has(versionParameter.name);
    validity.cacheControl = isImmutable ? "public, max-age=31536000, immutable" : "no-cache";
    validity.variesByAccept = variesByAccept;
    validity.conditional =
        answerPreconditions(call.request, validity.validators, validity.cacheControl, call.nowSeconds);
    if (validity.conditional && variesByAccept)
        validity.conditional->addToList("Vary", "Accept");
    return validity;
}

std::string keptKeyOf(const ApiCall& call, std::string_view variant) {
    return cat(call.cloud->version(), "\n", variant);
}

std::optional<HttpResponse> goneVersion(const ApiCall& call) {
    const std::string* wanted = call.query.find(versionParameter.name);
    if (!wanted || *wanted == call.cloud->version())
        return std::nullopt;
    return problemResponse({problem_types::versionGone,
                            cat("the cloud's version is now ", call.cloud->version()),
                            std::string(versionParameter.name)});
}

} // namespace stipple::server
