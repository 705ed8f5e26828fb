// What a server says in Location, as a reference from an address: "ADDRESS\nLOCATION". Wherever it leads is
// an http or https address, not from https to http, without what could end a line of the request, and the
// same again from its own text.
#include "client/headless/http_redirect.hpp"

#include <cstdint>
#include <cstdlib>

using namespace stipple;

namespace {

void require(bool holds) {
    if (!holds)
        std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string_view text(reinterpret_cast<const char*>(data), size);
    std::size_t end = text.find('\n');
    auto from = parseHttpUrl(text.substr(0, end));
    if (end == std::string_view::npos || !from)
        return 0;
    auto target = redirectTarget(*from, text.substr(end + 1), "here");
    if (!target) {
        require(target.error().code == ErrorCode::networkFailed);
        return 0;
    }
    require(target->isSecure || !from->isSecure);
    require(target->target.starts_with('/'));
    for (const std::string& part : {target->target, target->authority, target->host, target->port})
        for (char c : part)
            require(static_cast<unsigned char>(c) > ' ' && c != 127);
    std::string again = (target->isSecure ? "https://" : "http://") + target->authority + target->target;
    auto same = redirectTarget(*from, again, "here");
    require(same.ok() && same->target == target->target && originOf(*same) == originOf(*target));
    return 0;
}
