// The clouds that a server offers: `.stipple` files under short ids. Each is opened once and looked at again
// (one stat) on every use; a replaced file is opened anew, while downloads that run keep the old one.
// Thread: any.
#pragma once

#include "server/site/cloud_version.hpp"
#include "shared/base/result.hpp"

#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace stipple::server {

class CloudCatalog {
  public:
    struct Opened {
        std::unique_ptr<CloudCatalog> catalog;
        std::vector<Error> warnings; // files that were left out, and why
    };
    // `paths`: .stipple files, or folders whose .stipple files (not those of their subfolders) are taken,
    // sorted by name. Errors: notFound (a path that does not exist, or no usable cloud in any of them).
    static Result<Opened> open(const std::vector<std::string>& paths);

    // In the order of the paths. An id is the file's stem; bytes that are not letters, digits, ".", "_" or
    // "-" become "-"; a second cloud of the same id gets "-2" added.
    const std::vector<std::string>& ids() const { return ids_; }

    // Whether there is a cloud of this id, without looking into its file.
    bool holds(std::string_view id) const;

    // Errors: notFound (no such id, or the file is gone); truncated, corrupt or unsupported (what is there
    // now is no cloud); limitExceeded, ioFailed.
    Result<std::shared_ptr<const CloudVersion>> current(std::string_view id) const;

  private:
    struct Entry {
        std::string path;
        std::mutex mutex;
        std::shared_ptr<const CloudVersion> version;
    };
    void add(const std::string& path, std::shared_ptr<const CloudVersion> version);

    std::vector<std::string> ids_; // parallel to entries_
    std::vector<std::unique_ptr<Entry>> entries_;
};

} // namespace stipple::server
