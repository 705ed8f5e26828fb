#include "server/files/folder_listing.hpp"

#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <sys/resource.h>
#include <sys/stat.h>
#include <thread>

using namespace stipple;
using namespace stipple::server;
using namespace stipple::test;
namespace fs = std::filesystem;
using Names = std::vector<std::string>;

namespace {

// As if the folder had been left alone for long.
void age(const std::string& path, int seconds) {
    fs::last_write_time(path, fs::last_write_time(path) - std::chrono::seconds(seconds));
}

FolderListing listing(const TemporaryFolder& folder) {
    return FolderListing(folder.path(), ".stipple");
}

} // namespace

TEST_CASE("a listing has the files of its kind, sorted, and nothing else") {
    TemporaryFolder folder;
    for (const char* name :
         {"b.stipple", "a.stipple", "c.las", "stipple", ".hidden.stipple", "d.stipple.new"})
        writeText(folder.file(name), "");
    fs::create_directory(folder.file("folder.stipple"));
    ::mkfifo(folder.file("pipe.stipple").c_str(), 0600);
    fs::create_symlink("a.stipple", folder.file("link.stipple"));
    FolderListing files = listing(folder);
    CHECK(files.names().empty());
    CHECK(files.refresh());
    CHECK(files.names() == Names{"a.stipple", "b.stipple", "link.stipple"});
}

TEST_CASE("a folder that has been left alone is not read again until it changes") {
    TemporaryFolder folder;
    writeText(folder.file("a.stipple"), "");
    age(folder.path(), 10);
    FolderListing files = listing(folder);
    CHECK(files.refresh());
    CHECK_FALSE(files.refresh());
    std::this_thread::sleep_for(FolderListing::rereadPause * 2);
    CHECK_FALSE(files.refresh());
    writeText(folder.file("b.stipple"), "");
    CHECK(files.refresh());
    CHECK(files.names() == Names{"a.stipple", "b.stipple"});
    fs::remove(folder.file("a.stipple"));
    std::this_thread::sleep_for(FolderListing::rereadPause * 2);
    CHECK(files.refresh());
    CHECK(files.names() == Names{"b.stipple"});
}

// A change within the same tick of the file system's clock, as on one with ticks of seconds.
TEST_CASE("a change that leaves the folder's time as it was is noticed while that time is young") {
    TemporaryFolder folder;
    writeText(folder.file("a.stipple"), "");
    FolderListing files = listing(folder);
    CHECK(files.refresh());
    auto time = fs::last_write_time(folder.path());
    writeText(folder.file("b.stipple"), "");
    fs::last_write_time(folder.path(), time);
    std::this_thread::sleep_for(FolderListing::rereadPause * 2);
    CHECK(files.refresh());
    CHECK(files.names() == Names{"a.stipple", "b.stipple"});
}

TEST_CASE("a young folder is not read again on every use") {
    TemporaryFolder folder;
    FolderListing files = listing(folder);
    int readings = 0;
    auto end = std::chrono::steady_clock::now() + FolderListing::rereadPause * 2;
    while (std::chrono::steady_clock::now() < end)
        readings += files.refresh();
    CHECK(readings >= 1);
    CHECK(readings <= 4);
}

TEST_CASE("it can be told to read again") {
    TemporaryFolder folder;
    age(folder.path(), 10);
    FolderListing files = listing(folder);
    CHECK(files.refresh());
    CHECK_FALSE(files.refresh());
    files.readAgain();
    CHECK(files.refresh());
    CHECK_FALSE(files.refresh());
}

TEST_CASE("a folder that is gone has no names, and has them again when it is back") {
    TemporaryFolder folder;
    fs::create_directory(folder.file("inner"));
    writeText(folder.file("inner/a.stipple"), "");
    age(folder.file("inner"), 10);
    FolderListing files(folder.file("inner"), ".stipple");
    CHECK(files.refresh());
    fs::rename(folder.file("inner"), folder.file("away"));
    CHECK(files.refresh());
    CHECK(files.names().empty());
    CHECK(files.status().error().code == ErrorCode::notFound);
    CHECK_FALSE(files.refresh());
    fs::rename(folder.file("away"), folder.file("inner"));
    CHECK(files.refresh());
    CHECK(files.names() == Names{"a.stipple"});
    CHECK(files.status().ok());
}

TEST_CASE("a folder that can't be read for want of descriptors keeps the names it had, and is tried again") {
    TemporaryFolder folder;
    writeText(folder.file("a.stipple"), "");
    FolderListing files = listing(folder);
    CHECK(files.refresh());
    files.readAgain();
    struct rlimit before {};
    REQUIRE(::getrlimit(RLIMIT_NOFILE, &before) == 0);
    struct rlimit none = before;
    none.rlim_cur = 0;
    ::setrlimit(RLIMIT_NOFILE, &none);
    bool isRead = files.refresh();
    ::setrlimit(RLIMIT_NOFILE, &before);
    CHECK_FALSE(isRead);
    CHECK(files.names() == Names{"a.stipple"});
    CHECK(files.status().error().code == ErrorCode::ioFailed);
    CHECK(files.refresh());
    CHECK(files.status().ok());
}
