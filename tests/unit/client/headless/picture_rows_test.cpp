// Pictures by rows: the same as in one piece, and as PNG the same bytes however the rows come.
#include "client/headless/picture_rows.hpp"
#include "client/headless/png.hpp"
#include "tests/support/test_plan.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <utility>

using namespace stipple;
using namespace stipple::headless;
using namespace stipple::test;

namespace {

FramePlan widePlan(int width, int height) {
    TestView view;
    view.projection = Projection::orthographic;
    view.width = width;
    view.height = height;
    Style style;
    style.sizePixels = 7;
    style.shape = PointShape::circle;
    style.edl.radiusPixels = 4;
    TestNode node = randomNode(3, 20000, 12, {-5.0 * width / height, -5, -5}, 1);
    node.scale = {10.0 * width / height / 4096, 10.0 / 4096, 10.0 / 4096};
    return testPlan({node}, view, style);
}

Image gathered(FrameDrawer& drawer, FramePlan& plan, int& calls) {
    Image image{plan.width, 0, {}};
    calls = 0;
    Status drawn = drawRows(drawer, plan, [&](const Image& rows) {
        CHECK(rows.width == plan.width);
        image.rgba.insert(image.rgba.end(), rows.rgba.begin(), rows.rgba.end());
        image.height += rows.height;
        ++calls;
        return Status();
    });
    REQUIRE(drawn.ok());
    return image;
}

Image sample(int width, int height) {
    Image image{width, height, {}};
    TestRandom random(5);
    for (int i = 0; i < width * height; ++i)
        for (int c = 0; c < 4; ++c)
            image.rgba.push_back(c == 3 ? std::uint8_t{255} : static_cast<std::uint8_t>(random.below(256)));
    return image;
}

Result<Bytes> inBatches(const Image& image, int batch, const Status& refusal = {}) {
    Bytes bytes;
    STIPPLE_TRY(writer, PngWriter::begin(image.width, image.height, [&](ByteSpan more) {
                    bytes.insert(bytes.end(), more.begin(), more.end());
                    return bytes.size() > 500 ? refusal : Status();
                }));
    for (int y = 0; y < image.height; y += batch) {
        Image rows{image.width, std::min(batch, image.height - y), {}};
        auto from = image.rgba.begin() + std::ptrdiff_t{4} * image.width * y;
        rows.rgba.assign(from, from + std::ptrdiff_t{4} * image.width * rows.height);
        STIPPLE_CHECK(writer->append(rows));
    }
    STIPPLE_CHECK(writer->finish());
    return bytes;
}

void compare(Backend backend) {
    auto drawer = FrameDrawer::create(backend, 1);
    if (!drawer.ok()) {
        REQUIRE(backend == Backend::gles);
        WARN("skipped: " << drawer.error().sentence());
        return;
    }
    for (auto [width, height] : {std::pair{5003, 61}, {61, 5003}, {300, 200}}) {
        FramePlan plan = widePlan(width, height);
        int calls = 0;
        Image rows = gathered(**drawer, plan, calls);
        CHECK(calls == (height > 4096 ? 4 : 1));
        CHECK((plan.counters.nodesOutsidePart > 0 || plan.nodes.size() == 1));
        auto whole = (*drawer)->draw(plan);
        REQUIRE(whole.ok());
        CHECK(rows.height == height);
        CHECK(rows.rgba == (*whole)->rgba);
    }
}

} // namespace

TEST_CASE("a picture by rows is the one in one piece", "[software]") {
    compare(Backend::software);
}

TEST_CASE("with OpenGL ES, too, a picture by rows is the one in one piece", "[gles]") {
    compare(Backend::gles);
}

TEST_CASE("what refuses rows ends the picture", "[software]") {
    auto drawer = FrameDrawer::create(Backend::software, 1);
    REQUIRE(drawer.ok());
    FramePlan plan = widePlan(61, 5003);
    int calls = 0;
    Status drawn = drawRows(**drawer, plan, [&](const Image&) {
        ++calls;
        return Status(Error{ErrorCode::writeFailed, "no space", "a.png", ""});
    });
    REQUIRE_FALSE(drawn.ok());
    CHECK(drawn.error().code == ErrorCode::writeFailed);
    CHECK(calls == 1);
}

TEST_CASE("a PNG is the same however its rows come", "[png]") {
    Image image = sample(37, 41);
    auto whole = encodePng(image);
    REQUIRE(whole.ok());
    for (int batch : {1, 7, 41})
        CHECK(*inBatches(image, batch) == *whole);
}

TEST_CASE("a PNG whose bytes can't be kept, and rows that are not its own, are refused", "[png]") {
    Image image = sample(300, 200);
    auto refused = inBatches(image, 10, Error{ErrorCode::writeFailed, "no space", "a.png", ""});
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().code == ErrorCode::writeFailed);
    auto keep = [](ByteSpan) { return Status(); };
    CHECK(PngWriter::begin(0, 5, keep).error().code == ErrorCode::invalidArgument);
    auto writer = PngWriter::begin(300, 100, keep);
    REQUIRE(writer.ok());
    CHECK((*writer)->append(image).error().code == ErrorCode::invalidArgument); // too many
    CHECK((*writer)->append(sample(299, 1)).error().code == ErrorCode::invalidArgument);
    CHECK((*writer)->finish().error().code == ErrorCode::invalidArgument); // rows are missing
}
