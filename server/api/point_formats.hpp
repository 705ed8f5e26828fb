// The formats that points are answered in, wherever points are.
#pragma once

#include "converter/export/format_sink.hpp"
#include "server/http/negotiation.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace stipple::server {

// LAS and LAZ are registered with IANA (application/vnd.las, application/vnd.laszip); PLY has no type of its
// own.
inline constexpr Format jsonFormat{"json", "application/json", "json"};
inline constexpr Format csvFormat{"csv", "text/csv", "csv"};
inline constexpr Format lasFormat{"las", "application/vnd.las", "las"};
inline constexpr Format lazFormat{"laz", "application/vnd.laszip", "laz"};
inline constexpr Format plyFormat{"ply", "application/x-ply", "ply"};

// The format of files behind it; nothing for those that are not exported to files (JSON, stored nodes).
inline std::optional<ExportFormat> exportFormatOf(const Format& format) {
    return exportFormatFromName(format.name);
}

// "text/csv; charset=utf-8; header=present" and the like.
std::string contentTypeOf(const Format& format);
// For a file's name when it is saved: "attachment; filename=town-0-0-0-0.laz" (RFC 6266). `stem` is cut to
// letters, digits, ".", "_" and "-".
std::string contentDisposition(std::string_view stem, const Format& format);

} // namespace stipple::server
