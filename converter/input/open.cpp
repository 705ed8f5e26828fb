#include "converter/input/open.hpp"

#include "converter/input/cloud_input.hpp"
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
constexpr std::array kinds = {
    Kind{"LASF", "a LAS file",
         [](const std::string& path, const InputOptions&) { return openLasInput(path); }},
    Kind{"\x89STPL", "a Stipple cloud",
         [](const std::string& path, const InputOptions&) { return openCloudInput(path); }},
    Kind{"ASTM-E57", "an E57 file", nullptr},
    Kind{"ply\n", "a PLY file", nullptr},
    Kind{"ply\r", "a PLY file", nullptr},
    Kind{"# .PCD", "a PCD file", nullptr},
    Kind{"PK\x03\x04", "a ZIP archive", nullptr},
};

constexpr std::string_view readKinds = "give LAS, LAZ or Stipple files";
} // namespace

Result<std::unique_ptr<PointInput>> openInput(const std::string& path, const InputOptions& options) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        return Error{ErrorCode::unsupported, "this is a folder", path, "give the files in it"};
    std::string head;
    {
        STIPPLE_TRY(source, openFileSource(path));
        STIPPLE_TRY(bytes, readNow(*source, {0, startBytes}));
        head.assign(bytes.begin(), bytes.end());
    }
    if (head.empty())
        return Error{ErrorCode::truncated, "the file is empty", path, "was it copied completely?"};
    for (const Kind& kind : kinds)
        if (head.starts_with(kind.start)) {
            if (!kind.open)
                return Error{ErrorCode::unsupported, cat("this is ", kind.name, ", which is not read"), path,
                             std::string(readKinds)};
            return kind.open(path, options);
        }
    return Error{ErrorCode::unsupported, "the file is of no kind that is read", path, std::string(readKinds)};
}

} // namespace stipple
