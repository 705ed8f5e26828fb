#include "converter/input/open.hpp"

#include "converter/input/cloud_input.hpp"
#include "converter/input/e57/e57_input.hpp"
#include "converter/input/las_input.hpp"
#include "converter/input/pcd_input.hpp"
#include "converter/input/ply_input.hpp"
#include "converter/input/ptx_input.hpp"
#include "converter/input/text_input.hpp"
#include "shared/base/text.hpp"
#include "shared/io/file_source.hpp"

#include <array>
#include <filesystem>

namespace stipple {

namespace {
constexpr std::size_t startBytes = std::size_t{1} << 16;
using Opener = Result<std::unique_ptr<PointInput>> (*)(const std::string& path, const InputOptions& options);
using SourceOpener = Result<std::unique_ptr<PointInput>> (*)(const std::string& path,
                                                             std::unique_ptr<SharedSource> source,
                                                             const InputOptions& options);

template <SourceOpener open>
Result<std::unique_ptr<PointInput>> openWithSource(const std::string& path, const InputOptions& options) {
    STIPPLE_TRY(source, SharedSource::openFile(path, options.stop));
    return open(path, std::move(source), options);
}

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
         [](const std::string& path, const InputOptions& options) { return openE57Input(path, options); }},
    Kind{"ply\n", "a PLY file", openWithSource<openPlyInput>},
    Kind{"ply\r", "a PLY file", openWithSource<openPlyInput>},
    Kind{"ply ", "a PLY file", openWithSource<openPlyInput>},
    Kind{"PK\x03\x04", "a ZIP archive", nullptr},
    Kind{"\x1F\x8B", "a gzip file", nullptr},
    Kind{"\xFF\xD8\xFF", "a JPEG picture", nullptr},
    Kind{"\x89PNG", "a PNG picture", nullptr},
    Kind{"%PDF", "a PDF document", nullptr},
    Kind{std::string_view("II*\0", 4), "a TIFF picture", nullptr},
    Kind{"{", "a JSON file", nullptr},
    Kind{"<", "an XML or HTML file", nullptr},
};

constexpr std::string_view readKinds = "give LAS, LAZ, E57, PLY, PCD, PTX, PTS, text or Stipple files";

Result<std::string> startOf(const std::string& path) {
    STIPPLE_TRY(source, openFileSource(path));
    if (source->sizeBytes() == 0)
        return std::string();
    STIPPLE_TRY(bytes, readNow(*source, {0, startBytes}));
    return std::string(bytes.begin(), bytes.end());
}

constexpr Kind pcdKind{"", "a PCD file", openWithSource<openPcdInput>};
constexpr Kind ptxKind{"", "a PTX file", openWithSource<openPtxInput>};
constexpr Kind textKind{"", "a text file", openWithSource<openTextInput>};

// A PCD file may begin with comments of any words.
bool looksLikePcd(std::string_view start) {
    while (start.starts_with('#') && start.find('\n') != std::string_view::npos)
        start.remove_prefix(start.find('\n') + 1);
    return start.starts_with("VERSION") || start.starts_with("FIELDS");
}

// Null: of no known kind.
const Kind* kindOf(std::string_view start, const InputOptions& options) {
    for (const Kind& kind : kinds)
        if (start.starts_with(kind.start))
            return &kind;
    if (looksLikePcd(start))
        return &pcdKind;
    if (looksLikePtx(start))
        return &ptxKind;
    return looksLikeText(start, !options.columns.empty()) ? &textKind : nullptr;
}
} // namespace

InputKind inputKindOf(const std::string& path) {
    auto start = startOf(path);
    const Kind* kind = start ? kindOf(*start, {}) : nullptr;
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
    if (const Kind* kind = kindOf(start, options)) {
        if (!kind->open)
            return Error{ErrorCode::unsupported, cat("this is ", kind->name, ", which is not read"), path,
                         std::string(readKinds)};
        return kind->open(path, options);
    }
    return Error{ErrorCode::unsupported, "the file is of no kind that is read", path, std::string(readKinds)};
}

} // namespace stipple
