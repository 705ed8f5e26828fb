#include "server/files/root_folder.hpp"

#include <catch2/catch.hpp>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <sys/stat.h>
#include <unistd.h>

using namespace stipple;
using namespace stipple::server;
namespace fs = std::filesystem;

namespace {

// root/{inside.txt, sub/deep.txt, .hidden, links…} beside secret.txt.
class Tree {
  public:
    Tree() {
        std::string pattern = (fs::temp_directory_path() / "stipple-root-XXXXXX").string();
        base_ = ::mkdtemp(pattern.data());
        fs::create_directories(root() / "sub" / ".git");
        for (const char* name :
             {"secret.txt", "root/inside.txt", "root/sub/deep.txt", "root/.hidden", "root/sub/.git/config"})
            std::ofstream(base_ / name) << name;
        fs::create_symlink("inside.txt", root() / "link-inside.txt");
        fs::create_symlink("../secret.txt", root() / "link-out.txt");
        fs::create_symlink(base_ / "secret.txt", root() / "link-absolute.txt");
        fs::create_directory_symlink("..", root() / "folder-out");
        fs::create_symlink("loop", root() / "loop");
        ::mkfifo((root() / "pipe").c_str(), 0600);
    }
    ~Tree() { fs::remove_all(base_); }
    fs::path root() const { return base_ / "root"; }

  private:
    fs::path base_;
};

} // namespace

TEST_CASE("files inside the folder are opened") {
    Tree tree;
    auto root = RootFolder::open(tree.root().string());
    REQUIRE(root.ok());
    auto file = (*root)->openFile("sub/deep.txt");
    REQUIRE(file.ok());
    CHECK((*file)->identity().sizeBytes == std::string("root/sub/deep.txt").size());
}

TEST_CASE("nothing outside the folder is opened, and nothing hidden") {
    Tree tree;
    auto root = RootFolder::open(tree.root().string());
    REQUIRE(root.ok());
    for (const char* path :
         {"", "/etc/passwd", "../secret.txt", "sub/../../secret.txt", "link-out.txt", "link-absolute.txt",
          "folder-out/secret.txt", "loop", ".hidden", "sub/.git/config", "missing", "inside.txt/x"}) {
        INFO(path);
        auto file = (*root)->openFile(path);
        REQUIRE_FALSE(file.ok());
        CHECK(file.error().code == ErrorCode::notFound);
    }
}

TEST_CASE("folders and pipes are no files, and opening a pipe does not wait") {
    Tree tree;
    auto root = RootFolder::open(tree.root().string());
    REQUIRE(root.ok());
    for (const char* path : {"sub", "pipe"}) {
        auto file = (*root)->openFile(path);
        REQUIRE_FALSE(file.ok());
        CHECK(file.error().code == ErrorCode::invalidArgument);
    }
}

TEST_CASE("a file written to, cut or replaced has another entity tag") {
    Tree tree;
    std::string path = (tree.root() / "inside.txt").string();
    auto first = OpenFile::open(path);
    REQUIRE(first.ok());
    std::string tag = (*first)->identity().entityTag();
    CHECK((*first)->isUnchanged());

    SECTION("replaced by renaming: the open one is as it was") {
        std::ofstream(path + ".new") << "root/inside.txt";
        fs::rename(path + ".new", path);
        CHECK((*first)->isUnchanged());
        CHECK(identityOf(path)->entityTag() != tag);
    }
    SECTION("cut") {
        fs::resize_file(path, 3);
        CHECK_FALSE((*first)->isUnchanged());
        CHECK(identityOf(path)->entityTag() != tag);
        char bytes[8];
        CHECK((*first)->readAt(0, bytes, 3));
        CHECK_FALSE((*first)->readAt(0, bytes, 4));
    }
    SECTION("touched by a nanosecond") {
        struct timespec times[2] = {{0, UTIME_OMIT}, {1'600'000'000, 1}};
        REQUIRE(::utimensat(AT_FDCWD, path.c_str(), times, 0) == 0);
        std::string before = identityOf(path)->entityTag();
        times[1].tv_nsec = 2;
        REQUIRE(::utimensat(AT_FDCWD, path.c_str(), times, 0) == 0);
        CHECK(identityOf(path)->entityTag() != before);
    }
}
