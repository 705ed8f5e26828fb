// A folder whose files are served, and nothing outside it: every path is opened beneath the folder's
// descriptor, so neither "..", nor an absolute path, nor a symbolic link leads out (openat2(2),
// RESOLVE_BENEATH; where the kernel lacks or forbids that, no symbolic link is followed at all).
// Thread: any.
#pragma once

#include "server/files/open_file.hpp"
#include "shared/base/result.hpp"

#include <memory>
#include <string>

namespace stipple::server {

class RootFolder {
  public:
    // Errors: notFound, ioFailed, invalidArgument (not a folder).
    static Result<std::unique_ptr<RootFolder>> open(const std::string& path);
    ~RootFolder();
    RootFolder(const RootFolder&) = delete;
    RootFolder& operator=(const RootFolder&) = delete;

    // `relativePath` as Target::relativePath() gives it. Hidden names (".git") are notFound.
    // Errors: notFound (also for links that leave the folder), limitExceeded, ioFailed, invalidArgument.
    Result<std::shared_ptr<const OpenFile>> openFile(const std::string& relativePath) const;

  private:
    explicit RootFolder(int descriptor) : descriptor_(descriptor) {}
    int descriptor_;
};

} // namespace stipple::server
