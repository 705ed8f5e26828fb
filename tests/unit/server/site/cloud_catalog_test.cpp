// Ids, versions and what is left out: the catalog over a few files.
#include "server/site/cloud_catalog.hpp"

#include "tests/support/small_cloud.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <thread>

using namespace stipple;
using namespace stipple::server;
using namespace stipple::test;
namespace fs = std::filesystem;
using Ids = std::vector<std::string>;

namespace {

void write(const std::string& path, std::uint32_t seed = 1) {
    SmallCloudOptions options;
    options.levels = 1;
    options.pointsPerNode = 20;
    options.seed = seed;
    SmallCloud cloud = makeSmallCloud(options);
    writeText(path + ".new", std::string(cloud.file.begin(), cloud.file.end()));
    fs::rename(path + ".new", path);
}

std::unique_ptr<CloudCatalog> open(const Ids& paths, VersionCache::Limits limits = {}) {
    auto opened = CloudCatalog::open(paths, limits);
    REQUIRE(opened.ok());
    return std::move(opened->catalog);
}

ErrorCode codeOf(const CloudCatalog& catalog, const char* id) {
    auto version = catalog.current(id);
    REQUIRE_FALSE(version.ok());
    return version.error().code;
}

} // namespace

TEST_CASE("ids are the stems of files, made fit for addresses, each once") {
    TemporaryFolder folder;
    for (const char* name : {"a b.stipple", "a-b.stipple", "a.b.stipple",
                             "Stra\xC3\x9F"
                             "e.stipple"})
        write(folder.file(name));
    CHECK(open({folder.path()})->ids() == Ids{"Stra--e", "a-b", "a-b-2", "a.b"});
}

TEST_CASE("a cloud keeps its id, whatever comes and goes beside it") {
    TemporaryFolder folder;
    write(folder.file("b c.stipple"), 1);
    auto catalog = open({folder.path()});
    std::string tag = (*catalog->current("b-c"))->validators.etag;
    write(folder.file("b+c.stipple"), 2);
    write(folder.file("a.stipple"), 3);
    catalog->reload();
    CHECK(catalog->ids() == Ids{"a", "b-c", "b-c-2"});
    CHECK((*catalog->current("b-c"))->validators.etag == tag);
    fs::remove(folder.file("b c.stipple"));
    catalog->reload();
    CHECK(catalog->ids() == Ids{"a", "b-c-2"});
    CHECK(codeOf(*catalog, "b-c") == ErrorCode::notFound);
}

TEST_CASE("a folder may be empty at first, and a cloud in it is found when it is there") {
    TemporaryFolder folder;
    auto opened = CloudCatalog::open({folder.path()});
    REQUIRE(opened.ok());
    REQUIRE(opened->warnings.size() == 1);
    CHECK(opened->warnings[0].where == folder.path());
    CHECK(opened->catalog->ids().empty());
    write(folder.file("late.stipple"));
    for (int i = 0; i < 300 && !opened->catalog->holds("late"); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    CHECK(opened->catalog->current("late").ok());
    CHECK(opened->catalog->ids() == Ids{"late"});
}

TEST_CASE("a file that is named must be a cloud, one in a folder need not") {
    TemporaryFolder folder;
    writeText(folder.file("broken.stipple"), "nonsense");
    CHECK(CloudCatalog::open({folder.file("broken.stipple")}).error().where.find("broken") !=
          std::string::npos);
    CHECK(CloudCatalog::open({folder.file("none")}).error().code == ErrorCode::notFound);
    auto both = CloudCatalog::open({folder.path(), folder.file("broken.stipple")});
    REQUIRE(both.ok());
    CHECK(both->warnings.size() == 1);
    auto catalog = open({folder.path()});
    CHECK(catalog->ids() == Ids{"broken"});
    auto version = catalog->current("broken");
    CHECK_FALSE(version.ok());
    CHECK_FALSE(catalog->summary("broken").ok());
    write(folder.file("broken.stipple"));
    CHECK(catalog->current("broken").ok());
}

TEST_CASE("a replaced file is another version, and the old one stays readable") {
    TemporaryFolder folder;
    write(folder.file("a.stipple"), 1);
    auto catalog = open({folder.path()});
    auto old = *catalog->current("a");
    CHECK(*catalog->current("a") == old);
    write(folder.file("a.stipple"), 2);
    auto fresh = *catalog->current("a");
    CHECK(fresh->validators.etag != old->validators.etag);
    CHECK(catalog->summary("a")->etag == fresh->validators.etag);
    Bytes bytes(static_cast<std::size_t>(old->sizeBytes()));
    CHECK(old->file->readAt(0, bytes.data(), bytes.size()));
    CHECK(old->file->isUnchanged());
}

TEST_CASE("summaries say what the version says, and are known without opening it again") {
    TemporaryFolder folder;
    for (const char* name : {"a.stipple", "b.stipple"})
        write(folder.file(name));
    auto catalog = open({folder.path()}, {1, 1000000});
    CHECK_FALSE(catalog->knownSummary("a").has_value());
    CHECK_FALSE(catalog->knownSummary("none").has_value());
    CHECK(catalog->summary("a").ok());
    CHECK(catalog->summary("b").ok());
    CHECK(catalog->counts().opened == 2);
    auto known = catalog->knownSummary("a");
    REQUIRE(known.has_value());
    auto version = *catalog->current("a");
    CHECK(known->pointCount == version->metadata.pointCount);
    CHECK(known->etag == version->validators.etag);
    CHECK(known->sizeBytes == version->sizeBytes());
    CHECK(known->bounds.max.x == version->metadata.worldBounds().max.x);
    write(folder.file("a.stipple"), 2);
    CHECK_FALSE(catalog->knownSummary("a").has_value());
}

TEST_CASE("ids come in pages, of those that are wanted") {
    TemporaryFolder folder;
    for (const char* name : {"a.stipple", "b.stipple", "c.stipple", "d.stipple"})
        writeText(folder.file(name), "");
    auto catalog = open({folder.path()});
    auto all = [](const std::string&) { return true; };
    CHECK(catalog->idsAfter("", 2, all) == Ids{"a", "b"});
    CHECK(catalog->idsAfter("b", 2, all) == Ids{"c", "d"});
    CHECK(catalog->idsAfter("bb", 9, all) == Ids{"c", "d"});
    CHECK(catalog->idsAfter("d", 9, all).empty());
    CHECK(catalog->idsAfter("", 2, [](const std::string& id) { return id != "b"; }) == Ids{"a", "c"});
    CHECK(catalog->counts().opened == 0);
}
