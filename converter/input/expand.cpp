#include "converter/input/expand.hpp"

#include "converter/input/file_identity.hpp"
#include "converter/input/glob.hpp"
#include "converter/input/open.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

namespace stipple {

namespace fs = std::filesystem;

namespace {
constexpr std::size_t namedInWarning = 5;
constexpr std::string_view anyFolders = "**";

struct Entry {
    std::string name;
    bool isFolder = false, isLink = false; // of a link: what it leads to
};

// What a folder holds, sorted by name; "." as "".
Result<std::vector<Entry>> entriesOf(const std::string& folder) {
    std::vector<Entry> entries;
    std::error_code error, ignored;
    fs::directory_iterator at(folder.empty() ? "." : folder, error), end;
    while (!error && at != end) {
        entries.push_back(
            {at->path().filename().string(), at->is_directory(ignored), at->is_symlink(ignored)});
        at.increment(error);
    }
    if (error)
        return Error{ErrorCode::ioFailed, cat("the folder can't be read: ", error.message()), folder,
                     "give its files one by one, or mend its permissions"};
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.name < b.name; });
    return entries;
}

std::string joined(const std::string& folder, const std::string& name) {
    return folder.empty() || folder.back() == '/' ? folder + name : cat(folder, "/", name);
}

// Every file in and below a folder, but hidden ones.
Status addFilesBelow(const std::string& folder, std::vector<std::string>& files) {
    std::vector<std::string> open{folder};
    while (!open.empty()) {
        std::string at = std::move(open.back());
        open.pop_back();
        STIPPLE_TRY(entries, entriesOf(at));
        for (const Entry& entry : entries) {
            if (entry.name.starts_with('.'))
                continue;
            if (!entry.isFolder)
                files.push_back(joined(at, entry.name));
            else if (!entry.isLink)
                open.push_back(joined(at, entry.name));
        }
    }
    return {};
}

// A folder that a pattern has led to, and how many of the pattern's parts that took.
using Place = std::pair<std::string, std::size_t>;

std::vector<std::string> partsOf(const std::string& pattern) {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin <= pattern.size();) {
        std::size_t end = std::min(pattern.find('/', begin), pattern.size());
        if (end > begin)
            parts.push_back(pattern.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

// Where the rest of a pattern leads to from one folder: files that fit it, and folders to go on with.
Status step(const std::vector<std::string>& parts, const Place& place, std::vector<std::string>& files,
            std::vector<Place>& next) {
    const auto& [folder, index] = place;
    const std::string& part = parts[index];
    bool last = index + 1 == parts.size(), deep = part == anyFolders;
    if (!isPattern(part)) {
        std::string path = joined(folder, part);
        std::error_code ignored;
        if (last ? fs::is_regular_file(path, ignored) : fs::is_directory(path, ignored))
            last ? files.push_back(path) : next.push_back({path, index + 1});
        return {};
    }
    if (deep && !last)
        next.push_back({folder, index + 1});
    STIPPLE_TRY(entries, entriesOf(folder));
    for (const Entry& entry : entries) {
        if (!matchesPattern(entry.name, part))
            continue;
        std::string path = joined(folder, entry.name);
        if (!entry.isFolder && last)
            files.push_back(path);
        if (entry.isFolder && deep && !entry.isLink)
            next.push_back({path, index});
        if (entry.isFolder && !deep && !last)
            next.push_back({path, index + 1});
    }
    return {};
}

Result<std::vector<std::string>> filesOfPattern(const std::string& pattern) {
    std::vector<std::string> parts = partsOf(pattern), files;
    std::vector<Place> open{{pattern.starts_with('/') ? "/" : "", 0}};
    std::set<Place> seen; // several `**` lead to one place by many ways
    while (!open.empty() && !parts.empty()) {
        Place place = std::move(open.back());
        open.pop_back();
        if (seen.insert(place).second)
            STIPPLE_CHECK(step(parts, place, files, open));
    }
    return files;
}

class Expansion {
  public:
    explicit Expansion(const std::string& output) : output_(output) {}

    void addFile(const std::string& path) { paths_.push_back(path); }

    // Known beforehand: a file is not taken again by a folder named before it.
    void expect(const std::string& path) { isNew(path); }

    Status addFolder(const std::string& folder) {
        std::vector<std::string> files, scans, clouds, others;
        STIPPLE_CHECK(addFilesBelow(folder, files));
        std::sort(files.begin(), files.end());
        for (const std::string& file : files) {
            if (isOutput(file))
                continue;
            InputKind kind = inputKindOf(file);
            (kind == InputKind::scan ? scans : kind == InputKind::cloud ? clouds : others).push_back(file);
        }
        if (scans.empty())
            return Error{ErrorCode::notFound,
                         cat("the folder holds no scan that can be read", summary(others), summary(clouds)),
                         folder, "name the files to be read"};
        if (!others.empty())
            warnings_.push_back(cat(folder, ": left out, as not of a kind that is read", summary(others)));
        if (!clouds.empty())
            warnings_.push_back(
                cat(folder, ": left out; to add clouds, name them", summary(clouds, ".stipple file")));
        addFound(folder, scans);
        return {};
    }

    Status addPattern(const std::string& pattern) {
        STIPPLE_TRY(files, filesOfPattern(pattern));
        std::sort(files.begin(), files.end());
        files.erase(std::unique(files.begin(), files.end()), files.end());
        auto isTheOutput = [&](const std::string& file) { return isOutput(file); };
        std::size_t before = files.size();
        files.erase(std::remove_if(files.begin(), files.end(), isTheOutput), files.end());
        if (files.empty())
            return Error{ErrorCode::notFound,
                         before > 0 ? "only the output itself fits the pattern" : "no file fits the pattern",
                         pattern, "`*` stays inside a folder, `**` goes through all below"};
        addFound(pattern, files);
        return {};
    }

    ExpandedInputs take() { return {std::move(paths_), std::move(warnings_)}; }

  private:
    // "(12 files: a.txt, b.txt, …)", behind a blank; nothing for none.
    static std::string summary(const std::vector<std::string>& files, const std::string& noun = "file") {
        if (files.empty())
            return {};
        std::string text = cat(" (", files.size(), " ", noun, files.size() == 1 ? ": " : "s: ");
        for (std::size_t i = 0; i < std::min(files.size(), namedInWarning); ++i)
            text += cat(i > 0 ? ", " : "", fs::path(files[i]).filename().string());
        return text + (files.size() > namedInWarning ? ", …)" : ")");
    }

    // Notes the file; one that can't be looked at is new each time, and fails where it is opened.
    bool isNew(const std::string& path) {
        std::optional<FileIdentity> identity = fileIdentity(path);
        return !identity || known_.emplace(*identity, path).second;
    }
    // Two ways of writing one path, not two links to one file.
    static bool isSamePath(const std::string& a, const std::string& b) {
        std::error_code ignored;
        fs::path first(a), second(b);
        return first.filename() == second.filename() &&
               fs::equivalent(joined(first.parent_path().string(), "."),
                              joined(second.parent_path().string(), "."), ignored);
    }
    bool isOutput(const std::string& file) const {
        std::error_code ignored;
        return !output_.empty() && fs::equivalent(file, output_, ignored);
    }
    void addFound(const std::string& argument, const std::vector<std::string>& files) {
        std::vector<std::string> links;
        for (const std::string& file : files)
            if (isNew(file))
                paths_.push_back(file);
            else if (!isSamePath(known_[*fileIdentity(file)], file))
                links.push_back(file);
        if (!links.empty())
            warnings_.push_back(
                cat(argument, ": left out, as links to files that are read anyway", summary(links)));
    }

    std::string output_;
    std::vector<std::string> paths_, warnings_;
    std::map<FileIdentity, std::string> known_; // the path that each was first found by
};

bool mustExpand(const std::string& argument) {
    std::error_code ignored;
    return fs::is_directory(argument, ignored) || (!fs::exists(argument, ignored) && isPattern(argument));
}
} // namespace

Result<ExpandedInputs> expandInputs(const std::vector<std::string>& arguments, const std::string& output) {
    Expansion expansion(output);
    for (const std::string& argument : arguments)
        if (!mustExpand(argument))
            expansion.expect(argument);
    for (const std::string& argument : arguments) {
        std::error_code ignored;
        if (!mustExpand(argument))
            expansion.addFile(argument);
        else if (fs::is_directory(argument, ignored))
            STIPPLE_CHECK(expansion.addFolder(argument));
        else
            STIPPLE_CHECK(expansion.addPattern(argument));
    }
    return expansion.take();
}

} // namespace stipple
