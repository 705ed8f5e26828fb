#include "server/site/cloud_catalog.hpp"

#include "client/headless/http_url.hpp"
#include "server/upstream/upstream_cloud.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <unordered_set>

namespace stipple::server {

namespace {

namespace fs = std::filesystem;
using VersionPtr = std::shared_ptr<const CloudVersion>;
constexpr const char* fileSuffix = ".stipple";
constexpr const char* convertAdvice = "make one with `stipple convert SCAN -o NAME.stipple`";

std::string idOf(const std::string& name) {
    std::string id = fs::path(name).stem().string();
    for (char& c : id)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '_' && c != '-')
            c = '-';
    return id;
}

// "town.stipple" of "https://host/clouds/town.stipple?signature=…".
std::string nameOf(const std::string& url) {
    std::string path = url.substr(0, url.find_first_of("?#"));
    path.erase(0, path.find("://") + 3);
    std::size_t slash = path.find_last_of('/');
    bool isNamed = slash != std::string::npos && slash + 1 < path.size();
    return isNamed ? path.substr(slash + 1) : cat(path.substr(0, slash), fileSuffix);
}

bool isOf(const VersionPtr& version, const FileIdentity& identity) {
    return version && version->file && version->file->identity() == identity;
}

} // namespace

CloudSummary summaryOf(const CloudVersion& version) {
    return {version.metadata.name, version.metadata.pointCount, version.metadata.worldBounds(),
            version.sizeBytes(),   version.validators.etag,     version.version()};
}

Result<CloudCatalog::Opened> CloudCatalog::open(const std::vector<std::string>& paths,
                                                const VersionCache::Limits& limits,
                                                const UpstreamOptions& upstream) {
    Opened opened{std::unique_ptr<CloudCatalog>(new CloudCatalog(limits)), {}};
    CloudCatalog& catalog = *opened.catalog;
    for (const std::string& path : paths) {
        if (looksLikeUrl(path)) {
            STIPPLE_CHECK(catalog.addUpstream(path, upstream));
            continue;
        }
        std::error_code problem;
        if (!fs::exists(path, problem))
            return Error{ErrorCode::notFound, "there is no such file or folder", path, ""};
        if (fs::is_directory(path, problem)) {
            catalog.folders_.push_back({FolderListing(path, fileSuffix), {}});
            continue;
        }
        std::string id = catalog.add({path, nullptr}, path);
        if (auto version = catalog.openFile(id, path); !version) {
            opened.warnings.push_back(version.error());
            catalog.remove(id);
        }
    }
    catalog.refresh();
    for (const Folder& folder : catalog.folders_)
        if (!folder.listing.status())
            return folder.listing.status().error();
        else if (folder.listing.names().empty())
            opened.warnings.push_back(
                {ErrorCode::notFound, "the folder holds no .stipple file yet", folder.listing.path(), ""});
    if (!catalog.entries_.empty() || !catalog.folders_.empty())
        return opened;
    if (opened.warnings.size() == 1) // the one reason says more
        return opened.warnings.front();
    return Error{ErrorCode::notFound, "there is no cloud to serve", "", convertAdvice};
}

std::vector<std::string> CloudCatalog::ids() const {
    return idsAfter("", static_cast<std::size_t>(-1), [](const std::string&) { return true; });
}

std::vector<std::string> CloudCatalog::idsAfter(std::string_view after, std::size_t count,
                                                const std::function<bool(const std::string&)>& wanted) const {
    refresh();
    std::vector<std::string> ids;
    std::shared_lock lock(mutex_);
    for (auto at = entries_.upper_bound(after); at != entries_.end() && ids.size() < count; ++at)
        if (wanted(at->first))
            ids.push_back(at->first);
    return ids;
}

bool CloudCatalog::holds(std::string_view id) const {
    return find(std::string(id)).has_value();
}

Status CloudCatalog::addUpstream(const std::string& url, const UpstreamOptions& options) {
    if (!upstream_) {
        STIPPLE_TRY(opened, Upstream::open(options));
        upstream_ = opened;
    }
    STIPPLE_TRY(cloud, UpstreamCloud::open(upstream_, url));
    add({url, cloud}, nameOf(url));
    return {};
}

bool CloudCatalog::mustBePrepared(const std::string& id) const {
    if (!upstream_)
        return false;
    auto entry = findKnown(id);
    return entry && entry->upstream && entry->upstream->mustBePrepared();
}

bool CloudCatalog::isElsewhere(const std::string& id) const {
    auto entry = upstream_ ? findKnown(id) : std::nullopt;
    return entry && entry->upstream;
}

void CloudCatalog::prepare(const std::string& id, const std::atomic<bool>& stop) const {
    auto entry = findKnown(id);
    if (entry && entry->upstream)
        entry->upstream->prepare(stop);
}

Result<VersionPtr> CloudCatalog::current(std::string_view id) const {
    std::string key(id);
    auto entry = find(key);
    if (!entry)
        return Error{ErrorCode::notFound, "there is no such cloud", key, ""};
    if (entry->upstream)
        return entry->upstream->current();
    auto identity = identityOf(entry->path);
    if (!identity) {
        versions_.drop(key);
        refresh();
        return identity.error();
    }
    if (auto version = versions_.find(key); isOf(version, *identity))
        return version;
    std::lock_guard lock(opening_[std::hash<std::string>{}(key) % opening_.size()]);
    if (auto version = versions_.find(key); isOf(version, *identity)) // by another thread, meanwhile
        return version;
    versions_.drop(key);
    return openFile(key, entry->path);
}

Result<VersionPtr> CloudCatalog::openFile(const std::string& id, const std::string& path) const {
    auto file = OpenFile::open(path);
    if (!file && file.error().code == ErrorCode::limitExceeded) { // of descriptors, these can be spared
        closeHalf();
        file = OpenFile::open(path);
    }
    if (!file)
        return file.error();
    ++opened_;
    STIPPLE_TRY(version, readCloud(*file, path));
    versions_.keep(id, version);
    std::lock_guard lock(summariesMutex_);
    summaries_[id] = {(*file)->identity(), summaryOf(*version)};
    return version;
}

Result<CloudSummary> CloudCatalog::summary(const std::string& id) const {
    if (auto known = knownSummary(id))
        return *known;
    static const std::atomic<bool> neverStopped{false};
    prepare(id, neverStopped);
    STIPPLE_TRY(version, current(id));
    return summaryOf(*version);
}

std::optional<CloudSummary> CloudCatalog::knownSummary(const std::string& id) const {
    auto entry = findKnown(id);
    if (entry && entry->upstream) {
        auto version = mustBePrepared(id) ? Error{ErrorCode::cancelled, "", "", ""} : current(id);
        return version ? std::optional(summaryOf(**version)) : std::nullopt;
    }
    auto identity = entry ? identityOf(entry->path) : Error{ErrorCode::notFound, "", "", ""};
    if (!identity)
        return std::nullopt;
    std::lock_guard lock(summariesMutex_);
    auto known = summaries_.find(id);
    if (known == summaries_.end() || !(known->second.identity == *identity))
        return std::nullopt;
    return known->second.summary;
}

void CloudCatalog::reload() const {
    {
        std::lock_guard lock(foldersMutex_);
        for (Folder& folder : folders_)
            folder.listing.readAgain();
    }
    refresh();
}

CloudCatalog::Counts CloudCatalog::counts() const {
    std::shared_lock lock(mutex_);
    return {entries_.size(), versions_.size(), opened_};
}

std::optional<CloudCatalog::Entry> CloudCatalog::find(const std::string& id) const {
    auto entry = findKnown(id);
    if (entry || folders_.empty())
        return entry;
    refresh();
    return findKnown(id);
}

std::optional<CloudCatalog::Entry> CloudCatalog::findKnown(const std::string& id) const {
    std::shared_lock lock(mutex_);
    auto found = entries_.find(id);
    return found == entries_.end() ? std::nullopt : std::optional<Entry>(found->second);
}

void CloudCatalog::refresh() const {
    std::lock_guard lock(foldersMutex_);
    for (Folder& folder : folders_)
        if (folder.listing.refresh())
            takeOver(folder);
}

void CloudCatalog::takeOver(Folder& folder) const {
    const auto& names = folder.listing.names();
    std::unordered_set<std::string_view> present(names.begin(), names.end());
    for (auto known = folder.ids.begin(); known != folder.ids.end();) {
        if (present.contains(known->first)) {
            ++known;
            continue;
        }
        remove(known->second);
        known = folder.ids.erase(known);
    }
    for (const std::string& name : names)
        if (!folder.ids.contains(name))
            folder.ids[name] = add({(fs::path(folder.listing.path()) / name).string(), nullptr}, name);
}

std::string CloudCatalog::add(const Entry& entry, const std::string& name) const {
    std::unique_lock lock(mutex_);
    std::string stem = idOf(name), id = stem;
    for (int next = 2; entries_.contains(id); ++next)
        id = cat(stem, "-", next);
    entries_[id] = entry;
    return id;
}

void CloudCatalog::remove(const std::string& id) const {
    {
        std::unique_lock lock(mutex_);
        entries_.erase(id);
    }
    versions_.drop(id);
    std::lock_guard lock(summariesMutex_);
    summaries_.erase(id);
}

} // namespace stipple::server
