#include "server/api/point_formats.hpp"

#include "shared/base/text.hpp"

#include <cctype>

namespace stipple::server {

std::string contentTypeOf(const Format& format) {
    if (format.name == csvFormat.name)
        return "text/csv; charset=utf-8; header=present"; // RFC 4180 §3
    return std::string(format.mediaType);
}

std::string contentDisposition(std::string_view stem, const Format& format) {
    std::string name(stem);
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '_' && c != '-')
            c = '-';
    return cat("attachment; filename=", name, ".", format.extension);
}

} // namespace stipple::server
