#include "server/access/access_control.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sys/stat.h>

using namespace stipple;
using namespace stipple::server;
namespace fs = std::filesystem;

namespace {

struct Folder {
    fs::path path = [] {
        std::string pattern = (fs::temp_directory_path() / "stipple-access-XXXXXX").string();
        return fs::path(::mkdtemp(pattern.data()));
    }();
    std::string file = (path / "access.json").string();
    ~Folder() { fs::remove_all(path); }
};

mode_t modeOf(const std::string& path) {
    struct stat status {};
    REQUIRE(::stat(path.c_str(), &status) == 0);
    return status.st_mode & 0777;
}

} // namespace

TEST_CASE("an access file is written for its user alone, and keeps what its group may do") {
    Folder folder;
    AccessRules rules = freshAccessRules().value();
    REQUIRE(writeAccessFile(folder.file, rules).ok());
    CHECK(modeOf(folder.file) == 0600);
    ::chmod(folder.file.c_str(), 0644);
    auto exposed = readAccessFile(folder.file);
    REQUIRE_FALSE(exposed.ok());
    CHECK(exposed.error().code == ErrorCode::invalidArgument);
    ::chmod(folder.file.c_str(), 0640);
    CHECK(readAccessFile(folder.file).ok());
    REQUIRE(writeAccessFile(folder.file, rules).ok());
    CHECK(modeOf(folder.file) == 0640);
    ::chmod(folder.file.c_str(), 0666);
    REQUIRE(writeAccessFile(folder.file, rules).ok());
    CHECK((modeOf(folder.file) & 0007) == 0);
}

TEST_CASE("a run that was killed leaves nothing that a later one trips over") {
    Folder folder;
    std::ofstream(folder.file + ".new") << "half";
    REQUIRE(writeAccessFile(folder.file, freshAccessRules().value()).ok());
    CHECK(readAccessFile(folder.file).ok());
    CHECK_FALSE(fs::exists(folder.file + ".new"));
}

TEST_CASE("a folder that can't be written is said, and the file stays") {
    auto status = writeAccessFile("/nonexistent/access.json", freshAccessRules().value());
    REQUIRE_FALSE(status.ok());
    CHECK(status.error().code == ErrorCode::writeFailed);
}

TEST_CASE("rules are read anew, and stay as they were when the file is damaged") {
    Folder folder;
    AccessRules rules = freshAccessRules().value();
    REQUIRE(writeAccessFile(folder.file, rules).ok());
    auto control = AccessControl::open(folder.file);
    REQUIRE(control.ok());
    auto before = (*control)->rules();
    CHECK_FALSE(before->hidesAny());
    rules.privateClouds = {"*"};
    REQUIRE(writeAccessFile(folder.file, rules).ok());
    CHECK_FALSE((*control)->rules()->hidesAny());
    REQUIRE((*control)->reload().ok());
    CHECK((*control)->rules()->hidesAny());
    CHECK_FALSE(before->hidesAny());
    std::ofstream(folder.file) << "{";
    auto status = (*control)->reload();
    REQUIRE_FALSE(status.ok());
    CHECK(status.error().sentence().find(folder.file) != std::string::npos);
    CHECK((*control)->rules()->hidesAny());
    CHECK(AccessControl::open("/nonexistent").error().code == ErrorCode::notFound);
}
