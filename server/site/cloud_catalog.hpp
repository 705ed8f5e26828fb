// The clouds that a server offers: `.stipple` files under short ids, singly, all of a folder, or at another
// server. Thread: any.
//
// Nothing is opened before it is asked for, and only so many files stay open, however many there are. A
// cloud is looked at again (one stat) on every use: a replaced file is opened anew, while downloads that run
// keep the old one. Files that come to a folder or leave it are noticed when a list or an id that is not
// known is asked for (one stat of the folder).
#pragma once

#include "server/files/folder_listing.hpp"
#include "server/site/cloud_version.hpp"
#include "server/site/version_cache.hpp"
#include "server/upstream/upstream.hpp"
#include "shared/base/result.hpp"
#include "shared/geometry/box.hpp"

#include <array>
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace stipple::server {

// What lists say of a cloud.
struct CloudSummary {
    std::string name;
    std::uint64_t pointCount = 0;
    BoxD bounds; // world units; empty for an empty cloud
    std::uint64_t sizeBytes = 0;
    std::string etag, version; // CloudVersion::version()
};
CloudSummary summaryOf(const CloudVersion& version);

class UpstreamCloud;

class CloudCatalog {
  public:
    struct Opened {
        std::unique_ptr<CloudCatalog> catalog;
        std::vector<Error> warnings; // files that were left out, folders that hold nothing yet, and why
    };
    // `paths`: .stipple files, which must be clouds now, or folders whose .stipple files (not those of their
    // subfolders, nor hidden ones) are taken, whatever they turn out to be, or http and https addresses of
    // files, which nobody is asked for yet. Errors: notFound (a path that does not exist, or no usable cloud
    // among files alone); what parseHttpUrl and Upstream::open say of addresses.
    static Result<Opened> open(const std::vector<std::string>& paths, const VersionCache::Limits& limits = {},
                               const UpstreamOptions& upstream = {});

    // An id is the file's stem; bytes that are not letters, digits, ".", "_" or "-" become "-"; a second
    // cloud of the same id gets "-2" added. A cloud keeps its id while its file stays, whatever comes beside
    // it.
    std::vector<std::string> ids() const; // sorted
    // The first `count` ids behind `after` that are `wanted`.
    std::vector<std::string> idsAfter(std::string_view after, std::size_t count,
                                      const std::function<bool(const std::string&)>& wanted) const;
    // Whether there is a cloud of this id, without looking into its file.
    bool holds(std::string_view id) const;

    // Errors: notFound (no such id, or the file is gone); truncated, corrupt or unsupported (what is there
    // now is no cloud); limitExceeded, ioFailed.
    // Never waits for another server; see prepare().
    Result<std::shared_ptr<const CloudVersion>> current(std::string_view id) const;

    // Of a cloud at another server: whether it is time to look there, which prepare() does, waiting. Then
    // current() says what was found. Other clouds need none of this.
    bool mustBePrepared(const std::string& id) const;
    void prepare(const std::string& id, const std::atomic<bool>& stop) const;
    bool isElsewhere(const std::string& id) const;
    Upstream* upstream() const { return upstream_.get(); } // null: no cloud is at another server

    // Kept for every cloud that was open once, so lists do not open it again; waits for other servers.
    // Errors: as current().
    Result<CloudSummary> summary(const std::string& id) const;
    std::optional<CloudSummary> knownSummary(const std::string& id) const; // opens nothing

    // Closes half of the files that are open, those used longest ago. Downloads keep theirs until they end.
    void closeHalf() const { versions_.shrinkTo(versions_.size() / 2); }

    // Reads all folders again.
    void reload() const;

    struct Counts {
        std::size_t clouds = 0, open = 0;
        std::uint64_t opened = 0; // how often a file was opened, since the start
    };
    Counts counts() const;

  private:
    struct Entry {
        std::string path;
        std::shared_ptr<UpstreamCloud> upstream; // null: a file
    };
    struct Folder {
        FolderListing listing;
        std::unordered_map<std::string, std::string> ids; // by file name
    };
    struct KnownSummary {
        FileIdentity identity;
        CloudSummary summary;
    };

    explicit CloudCatalog(const VersionCache::Limits& limits) : versions_(limits) {}
    Result<std::shared_ptr<const CloudVersion>> openFile(const std::string& id,
                                                         const std::string& path) const;
    Status addUpstream(const std::string& url, const UpstreamOptions& options);
    std::optional<Entry> find(const std::string& id) const;
    std::optional<Entry> findKnown(const std::string& id) const;
    void refresh() const;
    void takeOver(Folder& folder) const;
    std::string add(const Entry& entry, const std::string& name) const; // the id, of a file's name
    void remove(const std::string& id) const;

    mutable std::mutex foldersMutex_; // taken before mutex_
    mutable std::vector<Folder> folders_;
    mutable std::shared_mutex mutex_;
    mutable std::map<std::string, Entry, std::less<>> entries_; // by id; under mutex_
    std::shared_ptr<Upstream> upstream_; // of clouds at other servers, if there are any
    mutable VersionCache versions_;
    mutable std::array<std::mutex, 64> opening_; // by hash of the id: a file is opened by one thread
    mutable std::mutex summariesMutex_;
    mutable std::unordered_map<std::string, KnownSummary> summaries_; // by id
    mutable std::atomic<std::uint64_t> opened_{0};
};

} // namespace stipple::server
