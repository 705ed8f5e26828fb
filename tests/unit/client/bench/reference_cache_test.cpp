#include "client/bench/reference_cache.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

using namespace stipple;
using namespace stipple::bench;
namespace fs = std::filesystem;

namespace {

CloudMetadata someCloud() {
    CloudMetadata metadata;
    metadata.pointHash = "0123";
    metadata.pointCount = 5;
    metadata.bounds = {{0, 0, 0}, {100, 100, 100}};
    return metadata;
}

DepthImage somePicture() {
    DepthImage picture{{16, 12, {}}, {}};
    for (int i = 0; i < 16 * 12; ++i) {
        for (int c = 0; c < 3; ++c)
            picture.image.rgba.push_back(static_cast<std::uint8_t>(i * (c + 3)));
        picture.image.rgba.push_back(255);
        picture.distances.push_back(i % 5 ? 1.0f / static_cast<float>(i) : 0.0f);
    }
    return picture;
}

ReferenceRequest someRequest() {
    ReferenceRequest request;
    request.width = 16;
    request.height = 12;
    request.style.intensityRange = {0, 1};
    return request;
}

} // namespace

TEST_CASE("a reference that was kept is found again, by another cache of the same cloud too") {
    test::TemporaryFolder folder;
    ReferenceCache cache(folder.file("references"), someCloud());
    CHECK_FALSE(cache.has(someRequest()));
    REQUIRE(cache.put(someRequest(), somePicture()).ok());
    ReferenceCache again(folder.file("references"), someCloud());
    CHECK(again.has(someRequest()));
    auto found = again.find(someRequest());
    REQUIRE(found);
    CHECK(found->image.rgba == somePicture().image.rgba);
    CHECK(found->distances == somePicture().distances);
}

TEST_CASE("another cloud, camera, style, size or number of samples is another reference") {
    test::TemporaryFolder folder;
    ReferenceCache cache(folder.file("references"), someCloud());
    REQUIRE(cache.put(someRequest(), somePicture()).ok());
    auto other = [&](auto change) {
        ReferenceRequest request = someRequest();
        change(request);
        return cache.has(request);
    };
    CHECK_FALSE(other([](ReferenceRequest& r) { r.camera.position.x = 1e-9; }));
    CHECK_FALSE(other([](ReferenceRequest& r) { r.style.edl.strength = 0.1; }));
    CHECK_FALSE(other([](ReferenceRequest& r) { r.style.intensityRange.max = 2; }));
    CHECK_FALSE(other([](ReferenceRequest& r) { r.width = 17; }));
    CHECK_FALSE(other([](ReferenceRequest& r) { r.samples = 2; }));
    CloudMetadata moved = someCloud();
    moved.grid.offset.x = 1;
    CHECK_FALSE(ReferenceCache(folder.file("references"), moved).has(someRequest()));
    CloudMetadata edited = someCloud();
    edited.pointHash = "0124";
    CHECK_FALSE(ReferenceCache(folder.file("references"), edited).has(someRequest()));
}

TEST_CASE("a damaged file is no reference") {
    test::TemporaryFolder folder;
    ReferenceCache cache(folder.file("references"), someCloud());
    REQUIRE(cache.put(someRequest(), somePicture()).ok());
    fs::path file = fs::directory_iterator(folder.file("references"))->path();
    for (std::uintmax_t size = fs::file_size(file); size > 0; size -= std::min<std::uintmax_t>(size, 37)) {
        fs::resize_file(file, size - 1);
        CHECK_FALSE(cache.find(someRequest()));
    }
}

TEST_CASE("without a folder nothing is kept; one that can't be made is an error") {
    ReferenceCache none("", someCloud());
    CHECK(none.put(someRequest(), somePicture()).ok());
    CHECK_FALSE(none.has(someRequest()));
    CHECK_FALSE(none.find(someRequest()));
    test::TemporaryFolder folder;
    std::ofstream(folder.file("file")) << "x";
    ReferenceCache bad(folder.file("file"), someCloud());
    CHECK(bad.put(someRequest(), somePicture()).error().code == ErrorCode::writeFailed);
}
