#include "server/verbs/view_inputs.hpp"

#include "client/headless/http_url.hpp"
#include "converter/build/convert.hpp"
#include "shared/base/text.hpp"
#include "shared/cli/progress.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/file_source.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <sys/stat.h>
#include <unistd.h>

namespace stipple::server {

namespace {

namespace fs = std::filesystem;
constexpr const char* cloudEnding = ".stipple";

// A folder that only this user can write to, so that nobody else can put a file in the way.
Result<std::string> privateFolder() {
    std::error_code ignored;
    fs::path folder = fs::temp_directory_path(ignored) / cat("stipple-view-", ::getuid());
    if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
        return Error{ErrorCode::ioFailed, cat("can't be made: ", std::strerror(errno)), folder.string(), ""};
    struct stat status {};
    if (::lstat(folder.c_str(), &status) != 0 || !S_ISDIR(status.st_mode) || status.st_uid != ::getuid() ||
        (status.st_mode & 0077) != 0)
        return Error{ErrorCode::ioFailed, "is not a folder of this user alone", folder.string(),
                     "remove it, or convert with `stipple convert` first"};
    return folder.string();
}

// What a cloud says of the scan that it was made of; nothing if it is no cloud, or was made of others.
std::optional<SourceFile> sourceOf(const std::string& cloud, const std::string& scan) {
    auto file = openFileSource(cloud);
    if (!file)
        return {};
    auto reader = CloudReader::open(**file);
    if (!reader)
        return {};
    const std::vector<SourceFile>& sources = (*reader)->metadata().sources;
    if (sources.size() != 1 || sources[0].name != fs::path(scan).filename().string())
        return {};
    return sources[0];
}

} // namespace

Result<std::string> convertedPath(const std::string& scan) {
    std::error_code problem;
    fs::path whole = fs::absolute(scan, problem), folder = whole.parent_path();
    std::string before;
    if (::access(folder.c_str(), W_OK) != 0) {
        STIPPLE_TRY(ours, privateFolder());
        // The same name in two folders must not be taken for the same scan.
        before = cat(std::hash<std::string>{}(folder.string()), "-");
        folder = ours;
    }
    fs::path plain = folder / cat(before, whole.stem().string(), cloudEnding);
    if (!fs::exists(plain, problem) || sourceOf(plain.string(), scan))
        return plain.string();
    return (folder / cat(before, whole.filename().string(), cloudEnding)).string();
}

bool isUpToDate(const std::string& converted, const std::string& scan) {
    std::error_code problem;
    auto made = fs::last_write_time(converted, problem);
    if (problem)
        return false;
    auto scanned = fs::last_write_time(scan, problem);
    auto source = sourceOf(converted, scan);
    return !problem && made >= scanned && source && source->sizeBytes == fs::file_size(scan, problem);
}

Result<std::string> prepareInput(const std::string& input, const std::atomic<bool>& stop) {
    if (looksLikeUrl(input))
        return input;
    std::error_code ignored;
    if (!fs::exists(input, ignored))
        return Error{ErrorCode::notFound, "there is no such file or folder", input, ""};
    if (fs::is_directory(input, ignored) || fs::path(input).extension() == cloudEnding ||
        inputKindOf(input) == InputKind::cloud)
        return input;
    STIPPLE_TRY(output, convertedPath(input));
    if (isUpToDate(output, input))
        return output;

    cli::Progress progress;
    ConvertOptions options;
    options.stop = &stop;
    options.name = fs::path(input).stem().string();
    auto converted = convertFiles({input}, output, options,
                                  [&](const std::string& phase, std::uint64_t done, std::uint64_t total) {
                                      progress.update(phase, done, total);
                                  });
    progress.finish();
    if (!converted)
        return converted.error();
    for (const std::string& warning : converted->warnings)
        std::fprintf(stderr, "stipple view: %s\n", warning.c_str());
    return output;
}

} // namespace stipple::server
