#include "server/verbs/view_inputs.hpp"

#include "converter/build/convert.hpp"
#include "shared/base/text.hpp"
#include "shared/cli/progress.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <sys/stat.h>
#include <unistd.h>

namespace stipple::server {

namespace {

namespace fs = std::filesystem;

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

} // namespace

Result<std::string> convertedPath(const std::string& scan) {
    std::error_code problem;
    fs::path whole = fs::absolute(scan, problem);
    fs::path name = whole.stem();
    name += ".stipple";
    if (::access(whole.parent_path().c_str(), W_OK) == 0)
        return (whole.parent_path() / name).string();
    STIPPLE_TRY(folder, privateFolder());
    // The same name in two folders must not be taken for the same scan.
    std::size_t hash = std::hash<std::string>{}(whole.parent_path().string());
    return (fs::path(folder) / cat(hash, "-", name.string())).string();
}

bool isUpToDate(const std::string& converted, const std::string& scan) {
    std::error_code problem;
    auto made = fs::last_write_time(converted, problem);
    if (problem)
        return false;
    auto scanned = fs::last_write_time(scan, problem);
    return !problem && made >= scanned;
}

Result<std::string> prepareInput(const std::string& input, const std::atomic<bool>& stop) {
    std::error_code ignored;
    if (!fs::exists(input, ignored))
        return Error{ErrorCode::notFound, "there is no such file or folder", input, ""};
    if (fs::is_directory(input, ignored) || fs::path(input).extension() == ".stipple")
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
