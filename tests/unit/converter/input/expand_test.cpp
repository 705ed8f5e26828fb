// Folders, patterns and names, to input files.
#include "converter/input/expand.hpp"

#include "shared/base/text.hpp"
#include "tests/support/temporary_folder.hpp"

#include <algorithm>
#include <filesystem>

using namespace stipple;
using namespace stipple::test;

namespace {
namespace fs = std::filesystem;
using Paths = std::vector<std::string>;

// A folder of scans, as far as their first bytes tell.
class Scans {
  public:
    Scans() {
        for (const char* name : {"b.las", "a.laz", "sub/deep/d.las", "sub/c.las", "straße/ö 東京.las"})
            put(name, "LASF");
        put("notes.txt", "read me");
        put("old.stipple", "\x89STPL\r\n");
        put(".hidden.las", "LASF");
        put("sub/empty.las", "");
    }
    std::string operator/(const std::string& name) const { return folder_.file(name); }
    void put(const std::string& name, const std::string& text) const {
        fs::create_directories(fs::path(folder_.file(name)).parent_path());
        writeText(folder_.file(name), text);
    }
    Paths all(const Paths& names) const {
        Paths paths;
        for (const std::string& name : names)
            paths.push_back(folder_.file(name));
        return paths;
    }
    std::string path() const { return folder_.path(); }

  private:
    TemporaryFolder folder_;
};

ExpandedInputs expanded(const Paths& arguments, const std::string& output = "") {
    auto result = expandInputs(arguments, output);
    if (!result)
        FAIL(result.error().sentence());
    return *result;
}
bool mentions(const ExpandedInputs& inputs, const std::string& part) {
    for (const std::string& warning : inputs.warnings)
        if (warning.find(part) != std::string::npos)
            return true;
    return false;
}
} // namespace

TEST_CASE("a folder gives every scan in and below it, sorted, and names what it leaves out", "[inputs]") {
    Scans scans;
    ExpandedInputs inputs = expanded({scans.path()});
    CHECK(inputs.paths == scans.all({"a.laz", "b.las", "straße/ö 東京.las", "sub/c.las", "sub/deep/d.las"}));
    CHECK(inputs.warnings.size() == 2);
    CHECK(mentions(inputs, "2 files: notes.txt, empty.las"));
    CHECK(mentions(inputs, "1 .stipple file: old.stipple"));
    CHECK(expanded({scans.path() + "/"}).paths == inputs.paths);
}

TEST_CASE("patterns give the files that fit, of any kind", "[inputs]") {
    Scans scans;
    CHECK(expanded({scans / "*.la[sz]"}).paths == scans.all({"a.laz", "b.las"}));
    CHECK(expanded({scans / "*/*.las"}).paths ==
          scans.all({"straße/ö 東京.las", "sub/c.las", "sub/empty.las"}));
    CHECK(expanded({scans / "**/*.las"}).paths ==
          scans.all({"b.las", "straße/ö 東京.las", "sub/c.las", "sub/deep/d.las", "sub/empty.las"}));
    CHECK(expanded({scans / "**/deep/**/**/d.las"}).paths == scans.all({"sub/deep/d.las"}));
    CHECK(expanded({scans / "stra?e/*"}).paths == scans.all({"straße/ö 東京.las"}));
    CHECK(expanded({scans / "*.stipple"}).paths == scans.all({"old.stipple"}));
    CHECK(expanded({scans / "sub/**"}).paths == scans.all({"sub/c.las", "sub/deep/d.las", "sub/empty.las"}));
}

TEST_CASE("patterns work from the current folder", "[inputs]") {
    Scans scans;
    fs::path before = fs::current_path();
    fs::current_path(scans.path());
    auto plain = expandInputs({"*.las"}, ""), up = expandInputs({"sub/../*.las"}, ""),
         deep = expandInputs({"**/d.las"}, "");
    fs::current_path(before);
    REQUIRE(plain.ok());
    CHECK(plain->paths == Paths{"b.las"});
    REQUIRE(up.ok());
    CHECK(up->paths == Paths{"sub/../b.las"});
    REQUIRE(deep.ok());
    CHECK(deep->paths == Paths{"sub/deep/d.las"});
}

TEST_CASE("a pattern that nothing fits, and a folder without scans, are errors that name it", "[inputs]") {
    Scans scans;
    fs::create_directories(scans / "none");
    scans.put("texts/a.txt", "x");
    for (const std::string& argument : scans.all({"*.ply", "nowhere/*.las", "**/none/*", "none", "texts"})) {
        CAPTURE(argument);
        auto result = expandInputs({scans / "a.laz", argument}, "");
        REQUIRE(!result.ok());
        CHECK(result.error().code == ErrorCode::notFound);
        CHECK(result.error().where == argument);
    }
}

TEST_CASE("a file whose name looks like a pattern is itself", "[inputs]") {
    Scans scans;
    scans.put("b[1]*.las", "LASF");
    CHECK(expanded({scans / "b[1]*.las"}).paths == scans.all({"b[1]*.las"}));
}

TEST_CASE("a file that does not exist is left to be opened", "[inputs]") {
    Scans scans;
    CHECK(expanded({scans / "gone.las"}).paths == scans.all({"gone.las"}));
}

TEST_CASE("the output is no input of its folder or pattern, but stays one where it is named", "[inputs]") {
    Scans scans;
    CHECK_FALSE(mentions(expanded({scans.path()}, scans / "sub/../old.stipple"), "old.stipple"));
    CHECK(expanded({scans / "*.*"}, scans / "old.stipple").paths ==
          scans.all({"a.laz", "b.las", "notes.txt"}));
    CHECK(expanded({scans / "old.stipple"}, scans / "old.stipple").paths == scans.all({"old.stipple"}));
    auto alone = expandInputs({scans / "*.stipple"}, scans / "old.stipple");
    REQUIRE(!alone.ok());
    CHECK(alone.error().sentence().find("only the output itself") != std::string::npos);
}

TEST_CASE("a file that several arguments lead to is taken once, where it is named", "[inputs]") {
    Scans scans;
    CHECK(expanded({scans / "*.las", scans / "b*", scans / "sub", scans / "sub/c.las"}).paths ==
          scans.all({"b.las", "sub/deep/d.las", "sub/c.las"}));
    // Named twice: opening the inputs refuses it.
    CHECK(expanded({scans / "b.las", scans / "b.las"}).paths.size() == 2);
}

TEST_CASE("links to files are followed, loops of links are not", "[inputs]") {
    Scans scans;
    fs::create_directory_symlink(scans.path(), scans / "sub/loop");
    fs::create_symlink(scans / "b.las", scans / "sub/link.las");
    CHECK(expanded({scans / "sub"}).paths == scans.all({"sub/c.las", "sub/deep/d.las", "sub/link.las"}));
    CHECK(expanded({scans / "**/b.las"}).paths == scans.all({"b.las"}));
    CHECK(expanded({scans.path()}).paths.size() == 5);
}

TEST_CASE("a file that a folder holds under several names is taken once, with a warning", "[inputs]") {
    Scans scans;
    fs::create_hard_link(scans / "b.las", scans / "c.las");
    fs::create_symlink(scans / "b.las", scans / "d.las");
    for (const std::string& argument : {scans.path(), scans / "*.la[sz]"}) {
        ExpandedInputs inputs = expanded({argument});
        CHECK(std::count(inputs.paths.begin(), inputs.paths.end(), scans / "b.las") == 1);
        CHECK(std::count(inputs.paths.begin(), inputs.paths.end(), scans / "c.las") == 0);
        CHECK(std::count(inputs.paths.begin(), inputs.paths.end(), scans / "d.las") == 0);
        CHECK(mentions(inputs, "c.las, d.las"));
    }
    // Another way of writing the folder is no other name of the file.
    CHECK(expanded({scans / "a*.laz", scans / "sub/../a*.laz"}).warnings.empty());
}

TEST_CASE("a folder that can't be read is an error that names it", "[inputs]") {
    Scans scans;
    fs::permissions(scans / "sub", fs::perms::none);
    std::error_code readable;
    fs::directory_iterator probe(scans / "sub", readable);
    auto result = expandInputs({scans.path()}, "");
    fs::permissions(scans / "sub", fs::perms::owner_all);
    if (!readable) {
        WARN("skipped: this user reads every folder");
        return;
    }
    REQUIRE(!result.ok());
    CHECK(result.error().code == ErrorCode::ioFailed);
    CHECK(result.error().where == scans / "sub");
}
