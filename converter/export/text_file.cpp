#include "converter/export/text_file.hpp"

#include "shared/base/text.hpp"
#include "shared/io/file_source.hpp"

namespace stipple {

Result<std::string> readTextFile(const std::string& path, std::uint64_t most, const char* what) {
    STIPPLE_TRY(source, openFileSource(path));
    if (source->sizeBytes() > most)
        return Error{ErrorCode::limitExceeded,
                     cat(what, " ", source->sizeBytes(), " bytes, more than ", most), path,
                     "give fewer corners"};
    STIPPLE_TRY(text, readNow(*source, {0, source->sizeBytes()}));
    return std::string(reinterpret_cast<const char*>(text.data()), text.size());
}

} // namespace stipple
