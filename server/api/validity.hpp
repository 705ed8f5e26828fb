// How long an answer about a cloud holds, and how a client asks whether it still does.
//
// An address that names the cloud's version ("?version=", CloudVersion::version()) means the same bytes for
// ever: such answers are immutable, and once the cloud is replaced the address is gone (410). Without it,
// clients revalidate, by a tag that is derived from the version and from all that the answer depends on, so
// that it is known without making the answer.
#pragma once

#include "server/api/endpoint.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace stipple::server {

// Of every endpoint below /clouds/{id}.
inline constexpr Parameter versionParameter{
    .name = "version",
    .description =
        "Version of the cloud, as its metadata have it. The answer may then be kept for ever; once "
        "the cloud has been replaced, it is 410.",
};

struct Validity {
    Validators validators;
    std::string cacheControl;
    bool variesByAccept = false;
    // Set: the request's conditions are answered by this (304, 412) if what it asks for exists.
    std::optional<HttpResponse> conditional;

    void setFields(HttpResponse& response) const;
};

// `variant`: what the answer depends on besides the cloud's version, in one canonical form.
Validity validityOf(const ApiCall& call, std::string_view variant, bool variesByAccept = false);

// By what an answer is kept here: all that it depends on, not the tag made of it, since two variants that
// have one tag can be found by who looks for them.
std::string keptKeyOf(const ApiCall& call, std::string_view variant);

// 410 if the request names another version than the cloud now has; nothing: go on.
std::optional<HttpResponse> goneVersion(const ApiCall& call);

} // namespace stipple::server
