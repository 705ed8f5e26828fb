#include "converter/input/open.hpp"

#include "converter/input/cloud_input.hpp"
#include "converter/input/e57/e57_input.hpp"
#include "converter/input/las_input.hpp"
#include "shared/base/text.hpp"
#include "shared/io/file_source.hpp"

#include <array>
#include <filesystem>

namespace stipple {

namespace {
constexpr std::size_t startBytes = 64;
using Opener = Result<std::unique_ptr<PointInput>> (*)(const std::string& path, const InputOptions& options);

struct Kind {
    std::string_view start; // a file of the kind begins with these bytes
    std::string_view name;
    Opener open; // null: known, but not read
};
constexpr std::string_view cloudName = "a Stipple cloud";
constexpr std::array kinds = {
    Kind{"LASF", "a LAS file",
         [](const std::string& path, const InputOptions&) { return openLasInput(path); }},
    Kind{"\x89STPL", cloudName,
         [](const std::string& path, const InputOptions&) { return openCloudInput(path); }},
    Kind{"ASTM-E57", "an E57 file",
         [](const std::string& path, const InputOptions& options) {
             return openE57Input(path, options.scale);
         }},
    Kind{"ply\n", "a PLY file", nullptr},
    Kind{"ply\r", "a PLY file", nullptr},
    Kind{"# .PCD", "a PCD file", nullptr},
    Kind{"PK\x03\x04", "a ZIP archive", nullptr},
};

constexpr std::string_view readKinds = "give LAS, LAZ, E57 or Stipple files";

Result<std::string> startOf(const std::string& path) {
    STIPPLE_TRY(source, openFileSource(path));
    STIPPLE_TRY(bytes, readNow(*source, {0, startBytes}));
    return std::string(bytes.begin(), bytes.end());
}

// Null: of no known kind.
const Kind* kindOf(std::string_view start) {
    for (const Kind& kind : kinds)
        if (start.starts_with(kind.start))
            return &kind;
    return nullptr;
}
} // namespace

InputKind inputKindOf(const std::string& path) {
    auto start = startOf(path);
    const Kind* kind = start ? kindOf(*start) : nullptr;
    if (!kind || !kind->open)
        return InputKind::notRead;
    return kind->name == cloudName ? InputKind::cloud : InputKind::scan;
}

Result<std::unique_ptr<PointInput>> openInput(const std::string& path, const InputOptions& options) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        return Error{ErrorCode::unsupported, "this is a folder", path, "give the files in it"};
    STIPPLE_TRY(start, startOf(path));
    if (start.empty())
        return Error{ErrorCode::truncated, "the file is empty", path, "was it copied completely?"};
    if (const Kind* kind = kindOf(start)) {
        if (!kind->open)
            return Error{ErrorCode::unsupported, cat("this is ", kind->name, ", which is not read"), path,
                         std::string(readKinds)};
        return kind->open(path, options);
    }
    return Error{ErrorCode::unsupported, "the file is of no kind that is read", path, std::string(readKinds)};
}

} // namespace stipple
