#include "converter/build/scan.hpp"

#include "shared/base/text.hpp"
#include "shared/io/file_source.hpp"

#include <array>
#include <filesystem>

namespace stipple {

namespace {
// The beginnings of files that are no LAS, so that the error can say what the file is.
struct KnownStart {
    std::string_view bytes, name;
};
constexpr std::array knownStarts = {
    KnownStart{"\x89STPL", "a Stipple file already"},
    KnownStart{"ASTM-E57", "an E57 file"},
    KnownStart{"ply\n", "a PLY file"},
    KnownStart{"ply\r", "a PLY file"},
    KnownStart{"# .PCD", "a PCD file"},
    KnownStart{"PK\x03\x04", "a ZIP archive"},
};
constexpr std::size_t startBytes = 105; // up to the point format, which says whether it is LAZ
constexpr std::size_t pointFormatByte = 104;

Error notLas(const std::string& path, std::string_view start) {
    for (const KnownStart& known : knownStarts)
        if (start.starts_with(known.bytes))
            return {ErrorCode::unsupported, cat("this is ", known.name, ", which is not read yet"), path,
                    "give LAS files"};
    return {ErrorCode::unsupported, "this is no LAS file: it does not begin with \"LASF\"", path,
            "give LAS files"};
}
} // namespace

Result<OpenInput> openInput(const std::string& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        return Error{ErrorCode::unsupported, "this is a folder", path, "give the files in it"};
    STIPPLE_TRY(source, openFileSource(path));
    STIPPLE_TRY(head, readNow(*source, {0, startBytes}));
    std::string_view start(reinterpret_cast<const char*>(head.data()), head.size());
    if (head.empty())
        return Error{ErrorCode::truncated, "the file is empty", path, ""};
    if (!start.starts_with("LASF"))
        return notLas(path, start);
    if (head.size() > pointFormatByte && (head[pointFormatByte] & 0xC0u) != 0)
        return Error{ErrorCode::unsupported, "this is a LAZ file (compressed LAS), which is not read yet",
                     path, "decompress it to LAS first"};
    auto reader = las::Reader::open(*source);
    if (!reader) {
        Error error = reader.error();
        return error.where.find(path) == std::string::npos ? error.at(path) : error;
    }
    return OpenInput{std::move(source), std::move(reader).value()};
}

} // namespace stipple
