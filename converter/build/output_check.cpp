#include "converter/build/output_check.hpp"

#include "shared/base/text.hpp"
#include "shared/io/file_source.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <unistd.h>

namespace stipple {

namespace fs = std::filesystem;

namespace {
bool beginsWith(const std::string& path, std::string_view magic) {
    auto source = openFileSource(path);
    if (!source)
        return false;
    auto head = readNow(**source, {0, magic.size()});
    return head && std::string_view(reinterpret_cast<const char*>(head->data()), head->size()) == magic;
}
} // namespace

Status checkOutput(const std::vector<std::string>& inputs, const std::string& output, bool force,
                   std::string_view magic) {
    std::error_code none; // what can't be looked at fails where it is opened
    for (const std::string& input : inputs)
        if (fs::equivalent(input, output, none))
            return Error{ErrorCode::invalidArgument, "the output is one of the inputs", output,
                         "give another name with -o"};
    if (fs::is_directory(output, none))
        return Error{ErrorCode::writeFailed, "the output is a folder", output, "give a file name with -o"};
    if (!force && fs::exists(output, none) && fs::file_size(output, none) > 0 && !beginsWith(output, magic))
        return Error{ErrorCode::writeFailed, "the output exists and is a file of another kind", output,
                     "give another name with -o, or --force to replace it"};
    fs::path folder = fs::path(output).parent_path();
    if (!folder.empty() && !fs::is_directory(folder, none))
        return Error{ErrorCode::writeFailed, "the folder of the output does not exist", output,
                     "make it first"};
    // Now, not when everything else is done.
    if (::access(folder.empty() ? "." : folder.c_str(), W_OK) != 0)
        return Error{ErrorCode::writeFailed,
                     cat("the folder of the output can't be written: ", std::strerror(errno)), output,
                     "choose another with -o"};
    return {};
}

} // namespace stipple
