// Where a conversion keeps what it has done so far, so that the same command can go on after a crash.
//
// The folder holds an `identity` (inputs with sizes and times, options that decide the bytes, program
// version), records that are replaced whole, and scratch files. It is locked while in use: locks end with the
// process, however it ends. Without keep() it is removed with the object, together with everything in it.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"
#include "shared/io/scratch_file.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stipple {

class WorkFolder {
  public:
    // Makes the folder, or takes up the one an earlier run with the same identity left. What a run with
    // another identity left is removed, and `warnings` say so. Errors: writeFailed (can't be made; in use by
    // another process).
    static Result<std::unique_ptr<WorkFolder>> open(const std::string& path, const std::string& identity,
                                                    std::vector<std::string>& warnings);
    ~WorkFolder();
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

    const std::string& path() const { return path_; }
    // An earlier run of the same conversion was here.
    bool resumes() const { return resumes_; }

    // A record: written beside the old one and renamed, with a checksum. load() answers notFound if there is
    // none, corrupt if it is damaged.
    Status save(const std::string& name, ByteSpan record);
    Result<Bytes> load(const std::string& name) const;
    Status remove(const std::string& name); // also if there is none

    // A scratch file that stays as long as the folder does: the earlier run's where there is one and
    // `reopen`, else a new one.
    Result<std::unique_ptr<ScratchFile>> scratch(const std::string& name, bool reopen);

    void keep() { keep_ = true; }

  private:
    WorkFolder(std::string path, int lock) : path_(std::move(path)), lock_(lock) {}

    std::string path_;
    int lock_; // descriptor
    bool resumes_ = false, keep_ = false;
};

} // namespace stipple
