#include "server/site/cloud_catalog.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace stipple::server {

namespace {

namespace fs = std::filesystem;
constexpr const char* convertAdvice = "make one with `stipple convert SCAN -o NAME.stipple`";

std::string idOf(const std::string& path) {
    std::string id = fs::path(path).stem().string();
    for (char& c : id)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '_' && c != '-')
            c = '-';
    return id;
}

Result<std::vector<std::string>> filesOf(const std::string& path) {
    std::error_code problem;
    if (!fs::is_directory(path, problem)) {
        if (!fs::exists(path, problem))
            return Error{ErrorCode::notFound, "there is no such file or folder", path, ""};
        return std::vector<std::string>{path};
    }
    std::vector<std::string> files;
    fs::directory_iterator at(path, problem), end;
    for (; !problem && at != end; at.increment(problem))
        if (at->path().extension() == ".stipple")
            files.push_back(at->path().string());
    if (problem)
        return Error{ErrorCode::ioFailed, cat("the folder can't be read: ", problem.message()), path, ""};
    std::sort(files.begin(), files.end());
    return files;
}

} // namespace

Result<CloudCatalog::Opened> CloudCatalog::open(const std::vector<std::string>& paths) {
    Opened opened{std::make_unique<CloudCatalog>(), {}};
    for (const std::string& path : paths) {
        STIPPLE_TRY(files, filesOf(path));
        if (files.empty())
            opened.warnings.push_back({ErrorCode::notFound, "the folder holds no .stipple file", path, ""});
        for (const std::string& filePath : files) {
            auto file = OpenFile::open(filePath);
            auto version = file ? readCloud(*file, filePath) : file.error();
            if (version)
                opened.catalog->add(filePath, *version);
            else
                opened.warnings.push_back(version.error());
        }
    }
    if (!opened.catalog->entries_.empty())
        return opened;
    Error nothing{ErrorCode::notFound, "there is no cloud to serve", "", convertAdvice};
    if (opened.warnings.size() == 1) // the one reason says more
        return opened.warnings.front();
    return nothing;
}

void CloudCatalog::add(const std::string& path, std::shared_ptr<const CloudVersion> version) {
    std::string stem = idOf(path), id = stem;
    for (int next = 2; std::find(ids_.begin(), ids_.end(), id) != ids_.end(); ++next)
        id = cat(stem, "-", next);
    ids_.push_back(id);
    auto entry = std::make_unique<Entry>();
    entry->path = path;
    entry->version = std::move(version);
    entries_.push_back(std::move(entry));
}

bool CloudCatalog::holds(std::string_view id) const {
    return std::find(ids_.begin(), ids_.end(), id) != ids_.end();
}

Result<std::shared_ptr<const CloudVersion>> CloudCatalog::current(std::string_view id) const {
    auto found = std::find(ids_.begin(), ids_.end(), id);
    if (found == ids_.end())
        return Error{ErrorCode::notFound, "there is no such cloud", std::string(id), ""};
    Entry& entry = *entries_[static_cast<std::size_t>(found - ids_.begin())];
    STIPPLE_TRY(identity, identityOf(entry.path));
    std::lock_guard lock(entry.mutex);
    if (entry.version->file->identity() == identity)
        return entry.version;
    STIPPLE_TRY(file, OpenFile::open(entry.path));
    STIPPLE_TRY(version, readCloud(file, entry.path));
    entry.version = version;
    return version;
}

} // namespace stipple::server
