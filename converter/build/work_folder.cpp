#include "converter/build/work_folder.hpp"

#include "shared/base/text.hpp"
#include "shared/codec/checksum.hpp"
#include "shared/io/file_source.hpp"
#include "shared/io/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <unistd.h>

namespace stipple {

namespace fs = std::filesystem;

namespace {
constexpr const char* identityName = "identity";
constexpr const char* lockName = "lock";

Error cannot(const std::string& path, const char* what, const std::string& reason) {
    return {ErrorCode::writeFailed, cat("the folder for temporary files ", what, ": ", reason), path,
            "choose another with --temp"};
}

void removeContents(const std::string& path) {
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(path, ignored))
        if (entry.path().filename() != lockName)
            fs::remove(entry.path(), ignored);
}
} // namespace

Result<std::unique_ptr<WorkFolder>> WorkFolder::open(const std::string& path, const std::string& identity,
                                                     std::vector<std::string>& warnings) {
    std::error_code failed;
    fs::create_directories(path, failed);
    if (failed)
        return cannot(path, "can't be made", failed.message());
    std::string lockPath = (fs::path(path) / lockName).string();
    int lock = ::open(lockPath.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock < 0)
        return cannot(path, "can't be written", std::strerror(errno));
    std::unique_ptr<WorkFolder> folder(new WorkFolder(path, lock));
    folder->keep_ = true; // until it is known to be ours
    if (::flock(lock, LOCK_EX | LOCK_NB) != 0)
        return Error{ErrorCode::writeFailed, "another conversion is writing this output", path,
                     "wait for it, or choose another output"};
    if (auto earlier = folder->load(identityName); earlier.ok()) {
        folder->resumes_ = std::string(earlier->begin(), earlier->end()) == identity;
        if (!folder->resumes_)
            warnings.push_back(cat(path,
                                   ": a conversion with other inputs or options was left unfinished here; "
                                   "what it had done is discarded"));
    }
    folder->keep_ = false;
    if (!folder->resumes_) {
        removeContents(path);
        STIPPLE_CHECK(folder->save(
            identityName, ByteSpan(reinterpret_cast<const std::uint8_t*>(identity.data()), identity.size())));
    }
    return folder;
}

WorkFolder::~WorkFolder() {
    if (!keep_) {
        std::error_code ignored;
        removeContents(path_);
        fs::remove(fs::path(path_) / lockName, ignored);
        fs::remove(path_, ignored);
    }
    ::close(lock_);
}

Status WorkFolder::save(const std::string& name, ByteSpan record) {
    STIPPLE_TRY(file, OutputFile::create((fs::path(path_) / name).string()));
    Bytes checksum(sizeof(std::uint64_t));
    storeLe(checksum.data(), xxh64(record));
    STIPPLE_CHECK(file->append(checksum));
    STIPPLE_CHECK(file->append(record));
    return file->commit();
}

Result<Bytes> WorkFolder::load(const std::string& name) const {
    STIPPLE_TRY(source, openFileSource((fs::path(path_) / name).string()));
    STIPPLE_TRY(bytes, readNow(*source, {0, source->sizeBytes()}));
    constexpr std::size_t checksumBytes = sizeof(std::uint64_t);
    if (bytes.size() < checksumBytes ||
        loadLe<std::uint64_t>(bytes.data()) != xxh64(ByteSpan(bytes).subspan(checksumBytes)))
        return Error{ErrorCode::corrupt, "the checkpoint is damaged", source->name(), "start again"};
    bytes.erase(bytes.begin(), bytes.begin() + checksumBytes);
    return std::move(bytes);
}

Status WorkFolder::remove(const std::string& name) {
    std::error_code failed;
    fs::path record = fs::path(path_) / name;
    fs::remove(record, failed);
    if (failed)
        return Error{ErrorCode::writeFailed, cat("can't be removed: ", failed.message()), record.string(),
                     ""};
    return {};
}

Result<std::unique_ptr<ScratchFile>> WorkFolder::scratch(const std::string& name, bool reopen) {
    std::string path = (fs::path(path_) / name).string();
    auto earlier = reopen ? ScratchFile::open(path)
                          : Result<std::unique_ptr<ScratchFile>>(Error{ErrorCode::notFound, "", "", ""});
    auto file = earlier.ok() ? std::move(earlier) : ScratchFile::create(path);
    if (file.ok())
        (*file)->keep(); // the folder removes it
    return file;
}

} // namespace stipple
