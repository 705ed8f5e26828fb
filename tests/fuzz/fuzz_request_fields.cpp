// Fields and queries that say who asks and for what: Authorization, signed addresses, Origin,
// Accept-Encoding; and what the log makes of them. Lines of the input: the query, Authorization, Origin,
// Accept-Encoding, User-Agent.
#include "server/access/signed_address.hpp"
#include "server/access/visitor.hpp"
#include "server/http/content_coding.hpp"
#include "server/http/cors.hpp"
#include "server/log/access_log.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

using namespace stipple;
using namespace stipple::server;

namespace {

constexpr std::int64_t now = 1'700'000'000;

void require(bool holds) {
    if (!holds)
        std::abort();
}

// Nobody guesses a key or a token: nothing opens a private cloud.
void checkRights(const HttpRequest& request, std::string_view query) {
    static const auto rules = [] {
        auto made = std::make_shared<AccessRules>();
        made->privateClouds = {"private*"};
        made->signingKey = Bytes(secretBytes, 0x5A);
        TokenRule token;
        token.id = "AAAAAAAA";
        token.clouds = {"*"};
        token.salt = Bytes(16);
        made->tokens.push_back(token);
        return made;
    }();
    Visitor visitor(rules, request, query, now);
    require(!visitor.mayRead("private") && visitor.mayRead("town"));
    auto there = visitor.refusal("private", true), absent = visitor.refusal("private", false);
    require(there && absent && there->status == absent->status && there->fields == absent->fields);
    require(!visitor.refusal("town", true));
    std::string rest = withoutSignature(query);
    require(!parseAddressSignature(rest).isPresent && withoutSignature(rest) == rest);
}

void checkCoding(const std::string& field) {
    for (std::string_view coding : {"br", "zstd", "gzip", "identity"}) {
        int quality = codingQuality(field, coding);
        require(quality >= 0 && quality <= 1000);
    }
}

void checkOrigin(std::string_view text, const HttpRequest& request) {
    if (auto origin = parseOrigin(text)) {
        require(parseOrigin(*origin).ok() && *parseOrigin(*origin) == *origin);
        require(origin->find_first_of(" \r\n/,", origin->find("://") + 3) == std::string::npos);
    }
    static const CorsRules rules = CorsRules::listing({"https://maps.example"}).value();
    HttpResponse response;
    rules.complete(request, response, false);
    std::string allowed = response.field("Access-Control-Allow-Origin");
    require(allowed.empty() || allowed == "https://maps.example");
}

void checkLog(const HttpRequest& request, std::string_view query) {
    static const std::string secret = signedQuery(Bytes(secretBytes, 0x5A), "private", now);
    RequestRecord record;
    record.method = request.method;
    record.target = std::string("/?").append(query);
    record.userAgent = request.field("User-Agent").value_or("");
    record.referer = std::string("https://").append(query);
    for (const std::string& line : {combinedLine(record), jsonLine(record)})
        require(std::all_of(line.begin(), line.end(), [](unsigned char c) { return c >= 0x20 && c < 0x7F; }));
    std::string signature = secret.substr(secret.find("signature=") + 10);
    std::string shown = withoutSecrets(std::string(query) + "&" + secret);
    bool isElsewhere = query.find(signature) != std::string_view::npos; // as part of something else
    require(isElsewhere || shown.find(signature) == std::string::npos);
    require(withoutSecrets(shown).size() <= shown.size());
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string_view text(reinterpret_cast<const char*>(data), size);
    std::array<std::string_view, 5> lines;
    for (std::string_view& line : lines) {
        std::size_t end = text.find('\n');
        line = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    HttpRequest request{"GET", lines[0], 11, {}};
    constexpr std::array<std::string_view, 4> names{"Authorization", "Origin", "Accept-Encoding",
                                                    "User-Agent"};
    for (std::size_t i = 0; i < names.size(); ++i)
        if (!lines[i + 1].empty())
            request.fields.emplace_back(names[i], lines[i + 1]);
    checkRights(request, lines[0]);
    checkOrigin(lines[2], request);
    checkCoding(std::string(lines[3]));
    checkLog(request, lines[0]);
    return 0;
}
