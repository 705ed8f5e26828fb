#include "server/site/page.hpp"

#include "server/files/content_type.hpp"
#include "server/http/problem.hpp"
#include "server/http/representation.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace stipple::server {

namespace {

constexpr const char* revalidated = "no-cache";
constexpr const char* immutable = "public, max-age=31536000, immutable";

// What our own page needs: its scripts, WebAssembly, workers (also from blobs), styles that Lit sets, clouds
// of other servers; nothing else, and no foreign page around it.
constexpr const char* contentSecurityPolicy =
    "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self' blob:; "
    "style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src 'self' blob: data: http: "
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

HttpResponse Page::answer(const HttpRequest& request, const Target& target, std::int64_t nowSeconds) const {
    std::string path = target.segments.empty() ? "index.html" : target.relativePath();
    HttpResponse response;
    if (!folder_ && path == "index.html") {
        response = answerRepresentation(
            request, Representation::ofText(notBuiltPage, std::string(contentTypeOf(path)), revalidated),
            nowSeconds);
    } else {
        auto file = folder_ ? folder_->openFile(path)
                            : Error{ErrorCode::notFound, "the page has not been built", path, ""};
        response =
            file ? answerRepresentation(request,
                                        Representation::ofFile(*file, std::string(contentTypeOf(path)),
                                                               isHashedAsset(path) ? immutable : revalidated),
                                        nowSeconds)
                 : problemResponse(file.error());
    }
    response.set("Content-Security-Policy", contentSecurityPolicy);
    response.set("Referrer-Policy", "no-referrer");
    return response;
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
