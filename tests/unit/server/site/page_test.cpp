#include "server/site/page.hpp"

#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::server;
using namespace stipple::test;
namespace fs = std::filesystem;

namespace {

struct PageFolder {
    TemporaryFolder folder;
    PageFolder() { fs::create_directory(folder.file("assets")); }
    void add(const std::string& name, int secondsOld = 0) {
        writeText(folder.file(name), name);
        fs::last_write_time(folder.file(name),
                            fs::file_time_type::clock::now() - std::chrono::seconds(secondsOld));
    }
    // The file chosen, by its content, and its coding.
    std::string chosen(const std::string& path, const char* accept) {
        auto root = RootFolder::open(folder.path());
        REQUIRE(root.ok());
        auto file =
            chooseCoding(**root, path, accept == nullptr ? std::nullopt : std::optional<std::string>(accept));
        if (!file)
            return file.error().code == ErrorCode::unsupported ? "406" : "404";
        std::string text(static_cast<std::size_t>(file->file->identity().sizeBytes), '\0');
        REQUIRE(file->file->readAt(0, text.data(), text.size()));
        return text + " " + file->coding;
    }
};

} // namespace

TEST_CASE("the coding with the highest quality is chosen; of equals br, zstd, gzip, none") {
    PageFolder page;
    for (const char* name : {"a.js", "a.js.br", "a.js.zst", "a.js.gz"})
        page.add(name);
    CHECK(page.chosen("a.js", "gzip, br, zstd") == "a.js.br br");
    CHECK(page.chosen("a.js", "gzip, zstd") == "a.js.zst zstd");
    CHECK(page.chosen("a.js", "gzip, zstd;q=0.9") == "a.js.gz gzip");
    CHECK(page.chosen("a.js", "gzip;q=0.5, identity") == "a.js ");
    CHECK(page.chosen("a.js", "gzip, identity") == "a.js.gz gzip");
    CHECK(page.chosen("a.js", nullptr) == "a.js ");
    CHECK(page.chosen("a.js", "*;q=0") == "406");
}

TEST_CASE("only what lies there can be chosen") {
    PageFolder page;
    page.add("a.js");
    page.add("a.js.gz");
    page.add("b.js.gz");
    CHECK(page.chosen("a.js", "br, gzip;q=0.1") == "a.js.gz gzip");
    CHECK(page.chosen("a.js", "br") == "a.js ");
    CHECK(page.chosen("a.js", "br, identity;q=0") == "406");
    CHECK(page.chosen("b.js", "gzip") == "404"); // coded alone
}

TEST_CASE("a coded file that is older than the plain one is of another version, unless its name has a hash") {
    PageFolder page;
    page.add("a.js");
    page.add("a.js.gz", 10);
    page.add("assets/a-A1b2C3d4.js");
    page.add("assets/a-A1b2C3d4.js.gz", 10);
    CHECK(page.chosen("a.js", "gzip") == "a.js ");
    CHECK(page.chosen("assets/a-A1b2C3d4.js", "gzip") == "assets/a-A1b2C3d4.js.gz gzip");
}

TEST_CASE("names with a hash are told from others") {
    for (const char* name :
         {"assets/index-B3x_9aQz.js", "assets/a-b-12345678.wasm", "assets/x--_______-.css"})
        CHECK(isHashedAsset(name));
    for (const char* name :
         {"index-B3x_9aQz.js", "assets/index.js", "assets/index-B3x9aQ.js", "assets/-1234567.js",
          "assets/index-B3x.9aQz.js", "assets/12345678", "assets/index_12345678.js"})
        CHECK_FALSE(isHashedAsset(name));
}
