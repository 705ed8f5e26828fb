// Files that get their name only when they are complete.
#include "shared/io/output_file.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {
const Bytes abc{'a', 'b', 'c'}, de{'d', 'e'};
} // namespace

TEST_CASE("an output has its name and bytes after commit, and nothing else is left") {
    TemporaryFolder folder;
    auto file = OutputFile::create(folder.file("out"));
    REQUIRE(file.ok());
    REQUIRE((*file)->append(abc).ok());
    REQUIRE((*file)->append(de).ok());
    REQUIRE((*file)->overwrite(1, de).ok());
    CHECK((*file)->sizeBytes() == 5);
    CHECK(!std::filesystem::exists(folder.file("out")));
    REQUIRE((*file)->commit().ok());
    CHECK(fileText(folder.file("out")) == "adede");
    CHECK(folder.fileCount() == 1);
}

TEST_CASE("an output that is given up leaves nothing, and what was there before") {
    TemporaryFolder folder;
    writeText(folder.file("out"), "before");
    {
        auto file = OutputFile::create(folder.file("out"));
        REQUIRE(file.ok());
        REQUIRE((*file)->append(abc).ok());
    }
    CHECK(fileText(folder.file("out")) == "before");
    CHECK(folder.fileCount() == 1);
}

TEST_CASE("an output replaces the file of its name at once") {
    TemporaryFolder folder;
    writeText(folder.file("out"), "before");
    auto file = OutputFile::create(folder.file("out"));
    REQUIRE(file.ok());
    REQUIRE((*file)->append(abc).ok());
    REQUIRE((*file)->commit().ok());
    CHECK(fileText(folder.file("out")) == "abc");
}

TEST_CASE("temporary files that a killed program left are not in the way") {
    TemporaryFolder folder;
    writeText(folder.file("out.part0"), "left over");
    auto file = OutputFile::create(folder.file("out"));
    REQUIRE(file.ok());
    REQUIRE((*file)->append(abc).ok());
    REQUIRE((*file)->commit().ok());
    CHECK(fileText(folder.file("out")) == "abc");
    CHECK(fileText(folder.file("out.part0")) == "left over");
}

TEST_CASE("bytes that were not written can't be overwritten") {
    TemporaryFolder folder;
    auto file = OutputFile::create(folder.file("out"));
    REQUIRE(file.ok());
    REQUIRE((*file)->append(abc).ok());
    CHECK((*file)->overwrite(2, de).error().code == ErrorCode::invalidArgument);
    CHECK((*file)->overwrite(~std::uint64_t{0}, de).error().code == ErrorCode::invalidArgument);
}

TEST_CASE("places that take no file are refused with their name") {
    TemporaryFolder folder;
    for (const std::string& path : {folder.file("absent/out"), folder.path()}) {
        auto file = OutputFile::create(path);
        REQUIRE(!file.ok());
        CHECK(file.error().code == ErrorCode::writeFailed);
        CHECK(file.error().where == path);
    }
    CHECK(folder.fileCount() == 0);
}
