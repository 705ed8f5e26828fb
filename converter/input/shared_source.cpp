#include "converter/input/shared_source.hpp"

#include "converter/input/input_file.hpp"

namespace stipple {

Result<std::unique_ptr<SharedSource>> SharedSource::openFile(const std::string& path,
                                                             const std::atomic<bool>* stop) {
    STIPPLE_TRY(source, openInputFile(path, stop));
    auto shared = std::make_unique<SharedSource>(std::move(source));
    shared->stop_ = stop;
    std::error_code unknown;
    shared->changed_ = std::filesystem::last_write_time(path, unknown);
    shared->isFile_ = !unknown;
    return shared;
}

Result<Bytes> SharedSource::read(ByteRange range) {
    if (range.offset >= sizeBytes_)
        return Bytes{};
    std::lock_guard lock(mutex_);
    STIPPLE_CHECK(open());
    return readNow(*source_, range);
}

void SharedSource::rest() {
    std::lock_guard lock(mutex_);
    if (isFile_)
        source_.reset();
}

Status SharedSource::open() {
    if (source_)
        return {};
    STIPPLE_TRY(source, openInputFile(name_, stop_));
    std::error_code unknown;
    if (source->sizeBytes() != sizeBytes_ || std::filesystem::last_write_time(name_, unknown) != changed_)
        return Error{ErrorCode::changed, "the file changed while it was being read", name_,
                     "convert again when it is complete"};
    source_ = std::move(source);
    return {};
}

} // namespace stipple
