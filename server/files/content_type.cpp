#include "server/files/content_type.hpp"

#include <array>
#include <utility>

namespace stipple::server {

std::string_view contentTypeOf(std::string_view fileName) {
    using Pair = std::pair<std::string_view, std::string_view>;
    static constexpr std::array types{
        Pair{".html", "text/html; charset=utf-8"},
        Pair{".js", "text/javascript; charset=utf-8"},
        Pair{".mjs", "text/javascript; charset=utf-8"},
        Pair{".css", "text/css; charset=utf-8"},
        Pair{".json", "application/json"},
        Pair{".map", "application/json"},
        Pair{".wasm", "application/wasm"}, // without it browsers refuse to compile while streaming
        Pair{".svg", "image/svg+xml"},
        Pair{".png", "image/png"},
        Pair{".jpg", "image/jpeg"},
        Pair{".webp", "image/webp"},
        Pair{".ico", "image/x-icon"},
        Pair{".woff2", "font/woff2"},
        Pair{".txt", "text/plain; charset=utf-8"},
        Pair{".webmanifest", "application/manifest+json"},
    };
    for (const auto& [extension, type] : types)
        if (fileName.ends_with(extension))
            return type;
    return "application/octet-stream";
}

} // namespace stipple::server
