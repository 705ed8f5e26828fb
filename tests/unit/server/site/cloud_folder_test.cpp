// A folder of thousands of clouds: opened one by one as they are asked for, from several threads.
#include "server/site/cloud_catalog.hpp"

#include "tests/support/small_cloud.hpp"
#include "tests/support/temporary_folder.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <random>
#include <thread>

using namespace stipple;
using namespace stipple::server;
using namespace stipple::test;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t maxOpen = 50;

std::string idOf(std::size_t number) {
    std::string digits = std::to_string(number);
    return "cloud-" + std::string(4 - digits.size(), '0') + digits;
}

std::size_t openDescriptors() {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator("/proc/self/fd"), {}));
}

// Links to one file: the catalog can't tell, and they are made in no time.
struct Clouds {
    TemporaryFolder folder;
    const std::size_t count;
    explicit Clouds(std::size_t fileCount) : count(fileCount) {
        SmallCloudOptions options;
        options.levels = 1;
        options.pointsPerNode = 5;
        SmallCloud cloud = makeSmallCloud(options);
        writeText(folder.file("one"), std::string(cloud.file.begin(), cloud.file.end()));
        for (std::size_t i = 0; i < count; ++i)
            add(i);
    }
    void add(std::size_t number) const { fs::create_hard_link(folder.file("one"), path(number)); }
    std::string path(std::size_t number) const { return folder.file(idOf(number) + ".stipple"); }
    std::unique_ptr<CloudCatalog> open() const {
        auto opened = CloudCatalog::open({folder.path()}, {maxOpen, 1u << 20});
        REQUIRE(opened.ok());
        return std::move(opened->catalog);
    }
};

} // namespace

TEST_CASE("a folder of 5000 clouds opens none until it is asked for, and few at a time") {
    Clouds clouds(5000);
    std::size_t before = openDescriptors();
    auto catalog = clouds.open();
    CHECK(catalog->ids().size() == clouds.count);
    CHECK(catalog->holds(idOf(4999)));
    CHECK_FALSE(catalog->holds("none"));
    CHECK(catalog->counts().opened == 0);
    CHECK(openDescriptors() == before);

    auto page = catalog->idsAfter(idOf(99), 100, [](const std::string&) { return true; });
    REQUIRE(page.size() == 100);
    CHECK(page.front() == idOf(100));
    for (const std::string& id : page)
        CHECK(catalog->summary(id).ok());
    CHECK(catalog->counts().opened == 100);
    CHECK(catalog->counts().open == maxOpen);
    for (const std::string& id : page) // again, from what is known
        CHECK(catalog->knownSummary(id).has_value());
    CHECK(catalog->counts().opened == 100);

    for (std::size_t i = 0; i < clouds.count; ++i)
        if (!catalog->current(idOf(i)).ok())
            FAIL(i);
    CHECK(catalog->counts().open == maxOpen);
    CHECK(openDescriptors() <= before + maxOpen);
}

TEST_CASE("clouds come to a large folder and leave it while many threads read") {
    Clouds clouds(1000);
    auto catalog = clouds.open();
    std::atomic<bool> isOver{false};
    std::atomic<std::size_t> wrong{0}, right{0};
    auto read = [&](unsigned seed) {
        std::mt19937 random(seed);
        while (!isOver) {
            std::size_t number = random() % clouds.count;
            auto version = catalog->current(idOf(number));
            // The upper half comes and goes.
            bool isWrong = version ? (*version)->sizeBytes() == 0
                                   : number < clouds.count / 2 || version.error().code != ErrorCode::notFound;
            isWrong ? ++wrong : ++right;
            if (number % 100 == 0)
                catalog->idsAfter(idOf(number), 10, [](const std::string&) { return true; });
        }
    };
    std::vector<std::thread> readers;
    for (unsigned seed = 1; seed <= 4; ++seed)
        readers.emplace_back(read, seed);
    for (std::size_t i = clouds.count / 2; i < clouds.count; i += 10) {
        fs::remove(clouds.path(i));
        if (i % 100 == 0)
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    catalog->reload();
    CHECK(catalog->ids().size() == clouds.count - clouds.count / 20);
    for (std::size_t i = clouds.count / 2; i < clouds.count; i += 10)
        clouds.add(i);
    catalog->reload();
    isOver = true;
    for (std::thread& reader : readers)
        reader.join();
    CHECK(catalog->ids().size() == clouds.count);
    CHECK(wrong == 0);
    CHECK(right > 0);
    CHECK(catalog->counts().open <= maxOpen);
}
