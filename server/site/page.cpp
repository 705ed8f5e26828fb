#include "server/site/page.hpp"

#include "server/files/content_type.hpp"
#include "server/http/content_coding.hpp"
#include "server/http/problem.hpp"
#include "server/http/representation.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace stipple::server {

namespace {

constexpr const char* revalidated = "no-cache";
constexpr const char* immutable = "public, max-age=31536000, immutable";

// What our own page needs: its scripts, WebAssembly, workers, style sheets, clouds of other servers; nothing
// else, and no foreign page around it.
constexpr const char* contentSecurityPolicy =
    "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; "
    "style-src 'self'; img-src 'self' data: blob:; connect-src 'self' blob: data: http: "
    "https:; "
    "object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'self'";

constexpr const char* notBuiltPage = R"(<!doctype html>
<html lang="en"><meta charset="utf-8"><title>Stipple</title>
<h1>Stipple is serving, but its page has not been built</h1>
<p>Build it with <code>scripts/demo.sh</code>, or in <code>www</code> with <code>npm ci &amp;&amp; npm run build</code>,
or name a built one with <code>--page DIR</code>; then load this address again.</p>
<p>The clouds are here all the same: <a href="/api/v1/clouds">/api/v1/clouds</a>.</p>
</html>
)";

// What a browser shows or runs with rights of its own: pages, pictures with scripts in them, workers.
bool isDocument(std::string_view contentType) {
    return contentType.starts_with("text/html") || contentType.starts_with("image/svg+xml") ||
           contentType.starts_with("text/javascript");
}

void setDocumentFields(HttpResponse& response) {
    response.set("Content-Security-Policy", contentSecurityPolicy);
    response.set("Referrer-Policy", "no-referrer");
    response.set("X-Frame-Options", "SAMEORIGIN"); // for browsers older than frame-ancestors
    response.set("Cross-Origin-Opener-Policy", "same-origin");
}

} // namespace

bool isHashedAsset(std::string_view path) {
    if (!path.starts_with("assets/"))
        return false;
    std::size_t dot = path.rfind('.');
    constexpr std::size_t hashLength = 8;
    if (dot == std::string_view::npos || dot < hashLength + 1 || path[dot - hashLength - 1] != '-')
        return false;
    std::string_view hash = path.substr(dot - hashLength, hashLength);
    return std::all_of(hash.begin(), hash.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
    });
}

Result<ChosenFile> chooseCoding(const RootFolder& folder, const std::string& path,
                                const std::optional<std::string>& acceptEncoding) {
    STIPPLE_TRY(plain, folder.openFile(path));
    ChosenFile chosen{plain, ""};
    int best = codingQuality(acceptEncoding, "identity");
    bool isPlainChosen = true;
    for (const ContentCoding& coding : storedCodings()) {
        int quality = codingQuality(acceptEncoding, coding.name);
        if (quality == 0 || quality < best || (quality == best && !isPlainChosen))
            continue;
        auto coded = folder.openFile(cat(path, coding.suffix));
        // An older one may be of another version. A hash in the name rules that out, whatever copying did to
        // the times.
        bool isCurrent =
            coded && (isHashedAsset(path) || (*coded)->identity().modifiedNs >= plain->identity().modifiedNs);
        if (!isCurrent)
            continue;
        chosen = {*coded, std::string(coding.name)};
        best = quality;
        isPlainChosen = false;
    }
    if (best == 0)
        return Error{ErrorCode::unsupported, "the file is in none of the codings that are accepted", path,
                     ""};
    return chosen;
}

HttpResponse Page::answer(const HttpRequest& request, const Target& target, std::int64_t nowSeconds) const {
    std::string path = target.segments.empty() ? "index.html" : target.relativePath();
    HttpResponse response;
    if (folder_)
        response = answerFile(request, path, nowSeconds);
    else if (path == "index.html")
        response = answerRepresentation(
            request, Representation::ofText(notBuiltPage, std::string(contentTypeOf(path)), revalidated),
            nowSeconds);
    else
        response = problemResponse(404, "there is nothing at this address");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    if (isDocument(response.field("Content-Type")))
        setDocumentFields(response);
    return response;
}

HttpResponse Page::answerFile(const HttpRequest& request, const std::string& path,
                              std::int64_t nowSeconds) const {
    auto chosen = chooseCoding(*folder_, path, request.field("Accept-Encoding"));
    if (!chosen) {
        if (chosen.error().code != ErrorCode::unsupported)
            return problemResponse(chosen.error());
        HttpResponse response = problemResponse({problem_types::notAcceptable, chosen.error().what});
        response.set("Vary", "Accept-Encoding");
        return response;
    }
    auto representation = Representation::ofFile(chosen->file, std::string(contentTypeOf(path)),
                                                 isHashedAsset(path) ? immutable : revalidated);
    representation.contentCoding = chosen->coding;
    representation.vary = "Accept-Encoding";
    return answerRepresentation(request, representation, nowSeconds);
}

Result<std::unique_ptr<RootFolder>> openPageFolder(const std::string& chosen) {
    if (!chosen.empty())
        return RootFolder::open(chosen);
    std::error_code ignored;
    std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    for (const std::string& candidate : {(program.parent_path().parent_path() / "share/stipple/www").string(),
                                         std::string(STIPPLE_PAGE_DIR)})
        if (std::filesystem::exists(candidate + "/index.html", ignored))
            return RootFolder::open(candidate);
    return std::unique_ptr<RootFolder>();
}

} // namespace stipple::server
