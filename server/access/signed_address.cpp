#include "server/access/signed_address.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <charconv>

namespace stipple::server {

namespace {

constexpr std::string_view expiresName = "expires", signatureName = "signature";

Digest signatureOf(ByteSpan key, std::string_view cloudId, std::int64_t expiresSeconds) {
    return hmacSha256(key, cat("stipple address 1\n", cloudId, "\n", expiresSeconds, "\n"));
}

// Takes "name=value" off the front of `query`.
std::string_view takeParameter(std::string_view& query) {
    std::size_t end = std::min(query.find('&'), query.size());
    std::string_view parameter = query.substr(0, end);
    query.remove_prefix(std::min(end + 1, query.size()));
    return parameter;
}

std::string_view nameOf(std::string_view parameter) {
    return parameter.substr(0, parameter.find('='));
}

std::string_view valueOf(std::string_view parameter) {
    return parameter.substr(std::min(parameter.find('='), parameter.size() - 1) + 1);
}

// Digits without leading zeros that fit 63 bits.
std::optional<std::int64_t> parseSeconds(std::string_view text) {
    std::int64_t value = 0;
    auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || std::to_string(value) != text ||
        value < 0)
        return std::nullopt;
    return value;
}

} // namespace

std::string signedQuery(ByteSpan key, std::string_view cloudId, std::int64_t expiresSeconds) {
    return cat(expiresName, "=", expiresSeconds, "&", signatureName, "=",
               base64Url(signatureOf(key, cloudId, expiresSeconds)));
}

AddressSignature parseAddressSignature(std::string_view query) {
    int expiresCount = 0, signatureCount = 0;
    std::optional<std::int64_t> expires;
    std::string_view signature;
    while (!query.empty()) {
        std::string_view parameter = takeParameter(query);
        if (nameOf(parameter) == expiresName) {
            ++expiresCount;
            expires = parseSeconds(valueOf(parameter));
        } else if (nameOf(parameter) == signatureName) {
            ++signatureCount;
            signature = valueOf(parameter);
        }
    }
    AddressSignature found;
    found.isPresent = expiresCount + signatureCount > 0;
    if (expiresCount == 1 && signatureCount == 1 && expires)
        found.values = {*expires, std::string(signature)};
    return found;
}

bool isValid(const AddressSignature& signature, ByteSpan key, std::string_view cloudId,
             std::int64_t nowSeconds) {
    if (!signature.values || signature.values->expiresSeconds <= nowSeconds)
        return false;
    auto given = fromBase64Url(signature.values->signature);
    return given && equalInConstantTime(*given, signatureOf(key, cloudId, signature.values->expiresSeconds));
}

std::string withoutSignature(std::string_view query) {
    std::string rest;
    for (bool isFirst = true, isLast = false; !isLast;) {
        isLast = query.find('&') == std::string_view::npos;
        std::string_view parameter = takeParameter(query);
        if (nameOf(parameter) == expiresName || nameOf(parameter) == signatureName)
            continue;
        rest.append(isFirst ? "" : "&").append(parameter);
        isFirst = false;
    }
    return rest;
}

} // namespace stipple::server
