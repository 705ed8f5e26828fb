#include "server/site/cloud_catalog.hpp"

#include "shared/base/text.hpp"
#include "shared/format/block_frame.hpp"
#include "shared/format/cloud_file.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace stipple::server {

namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t maxMetadataBytes = 64ull << 20;
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

Result<Bytes> readPart(const OpenFile& file, ByteRange range, const std::string& what) {
    std::uint64_t sizeBytes = file.identity().sizeBytes;
    if (range.offset > sizeBytes || range.size > sizeBytes - range.offset)
        return Error{ErrorCode::truncated, cat("the file ends inside its ", what), "", convertAdvice};
    if (range.size > maxMetadataBytes)
        return Error{ErrorCode::limitExceeded, cat("the ", what, " is larger than 64 MiB"), "", ""};
    Bytes bytes(static_cast<std::size_t>(range.size));
    if (!file.readAt(range.offset, bytes.data(), bytes.size()))
        return Error{ErrorCode::ioFailed, cat("the ", what, " can't be read"), "", ""};
    return bytes;
}

Status readMetadata(const OpenFile& file, CloudVersion& version) {
    std::uint64_t sizeBytes = file.identity().sizeBytes;
    STIPPLE_TRY(head, readPart(file, {0, std::min<std::uint64_t>(fileHeaderBytes, sizeBytes)}, "header"));
    STIPPLE_TRY(header, parseFileHeader(head));
    if (header.fileBytes != sizeBytes)
        return Error{ErrorCode::truncated,
                     cat("the file has ", sizeBytes, " bytes, its header says ", header.fileBytes), "",
                     "copy or convert it again"};
    STIPPLE_TRY(block, readPart(file, header.metadata, "metadata"));
    STIPPLE_TRY(metadata, parseMetadata(block));
    STIPPLE_TRY(text, unframeBlock(block, "metadata", header.metadata.offset));
    version.metadata = std::move(metadata);
    version.metadataText.assign(text.begin(), text.end());
    return {};
}

} // namespace

Result<std::shared_ptr<const CloudVersion>> readCloud(std::shared_ptr<const OpenFile> file,
                                                      const std::string& name) {
    auto version = std::make_shared<CloudVersion>();
    if (Status status = readMetadata(*file, *version); !status)
        return status.error().at(name);
    version->file = std::move(file);
    return std::shared_ptr<const CloudVersion>(std::move(version));
}

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
