#include "client/core/node_paint.hpp"

#include "client/core/gradients.hpp"
#include "shared/points/point_classes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace stipple;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A node of points along x at 0, 1, 2 …, 10 steps of 0.5 apart, with what a test gives it.
struct Fixture {
    ColourStyle style;
    Clips clips;
    Schema schema;
    Grid grid{{0.5, 0.5, 0.5}, {0, 0, 0}};
    Vec3i corner{0, 0, 0};
    ResidentNode node;
    std::vector<std::shared_ptr<const NodeColumns>> columns;
    bool exact = false, continuous = false;
    double rootSpacing = 3;
    RankDensity density;

    explicit Fixture(std::uint32_t points) {
        NodePicture picture;
        for (std::uint32_t i = 0; i < points; ++i)
            picture.positions.push_back({10 * i, 3, 10 * i});
        node = packNode({4, 0, 0, 0}, 10, points, picture, PictureColour::none, false);
        density = rankDensity(4, rootSpacing / 16, points);
    }

    template <class T>
    void addColumn(Attribute attribute, std::vector<T> values) {
        ByteWriter bytes;
        for (T value : values)
            bytes.write(value);
        auto index = static_cast<std::int32_t>(schema.attributes.size());
        std::uint32_t stride = static_cast<std::uint32_t>(attribute.size());
        schema.attributes.push_back(std::move(attribute));
        columns.push_back(
            std::make_shared<NodeColumns>(NodeColumns{node.pointCount, {{index, stride}}, bytes.take()}));
    }

    std::shared_ptr<const NodePaint> paint() {
        auto made = Clips::make(style.clipBoxes, style.clipRegions);
        REQUIRE(made.ok());
        clips = std::move(*made);
        BoxD box;
        box.extend(grid.toWorld(corner));
        box.extend(grid.toWorld(corner + Vec3i{1023, 1023, 1023}));
        Painter painter(style, clips, schema, grid, false, continuous);
        return painter.paint(
            {std::make_shared<ResidentNode>(node), columns, corner, box, exact, density, rootSpacing});
    }
    std::vector<bool> shown() {
        auto painted = paint();
        std::vector<bool> all;
        for (std::size_t i = 0; i < node.pointCount; ++i)
            all.push_back(!painted || painted->shows(i));
        return all;
    }
};

using Shown = std::vector<bool>;

} // namespace

TEST_CASE("a node in its own colours needs no paint, hidden points do") {
    Fixture f(3);
    CHECK_FALSE(f.paint());
    f.addColumn<std::uint8_t>({"Classification", AttributeType::u8}, {2, 6, 2});
    CHECK_FALSE(f.paint());
    f.style.hiddenClasses.set(6);
    auto paint = f.paint();
    REQUIRE(paint);
    CHECK(paint->hidden == 1);
    CHECK(f.shown() == Shown{true, false, true});
    CHECK((*paint->words)[0] == plainColourWord);
    CHECK((*paint->words)[1] == (plainColourWord & 0xFFFFFF));
}

TEST_CASE("classes have the colours of the table") {
    Fixture f(256);
    std::vector<std::uint8_t> all;
    for (int i = 0; i < 256; ++i)
        all.push_back(static_cast<std::uint8_t>(i));
    f.addColumn<std::uint8_t>({"Classification", AttributeType::u8}, all);
    f.style.colourMode = ColourMode::classification;
    auto paint = f.paint();
    for (std::size_t i = 0; i < 256; ++i) {
        auto colour = classColour(static_cast<std::uint8_t>(i));
        CHECK((*paint->words)[i] ==
              (colour[0] | std::uint32_t{colour[1]} << 8 | std::uint32_t{colour[2]} << 16 | 0xFF000000u));
    }
    // The classes that LAS names are told apart.
    for (int a = 0; a < 23; ++a)
        for (int b = 0; b < a; ++b)
            CHECK(classColour(static_cast<std::uint8_t>(a)) != classColour(static_cast<std::uint8_t>(b)));
}

TEST_CASE("GPS times a microsecond apart are told apart") {
    Fixture f(3);
    const double start = 390583952.349590;
    f.addColumn<double>({"GPS Time", AttributeType::f64}, {start, start + 1e-6, start + 2e-6});
    f.style.colourMode = ColourMode::gpsTime;
    f.style.gradient = GradientName::grey;
    f.style.attributeRange = {start, start + 2e-6};
    auto paint = f.paint();
    CHECK(((*paint->words)[0] & 255) == 0);
    CHECK(((*paint->words)[1] & 255) == Approx(127).margin(8)); // a double there has steps of 6e-8
    CHECK(((*paint->words)[2] & 255) == 255);
    f.style.filters = {{"GPS Time", start + 0.5e-6, start + 1.5e-6}};
    CHECK(f.shown() == Shown{false, true, false});
}

TEST_CASE("ranges are closed, of what values mean, and NaN and no value are in none") {
    Fixture f(5);
    Attribute scaled{"Range", AttributeType::i16};
    scaled.scale = 0.1;
    scaled.offset = -5;
    scaled.noData = -1;
    f.addColumn<std::int16_t>(scaled, {53, 56, 57, -1, 60}); // 0.3, 0.6, 0.7, none, 1
    f.style.filters = {{"range", 0.3, 0.7}};
    CHECK(f.shown() == Shown{true, true, true, false, false});
    f.style.filters = {{"Range", -infinity, infinity}};
    CHECK(f.shown() == Shown{true, true, true, false, true});
    f.addColumn<float>({"Other", AttributeType::f32}, {NAN, 1, 2, 3, 4});
    f.style.filters = {{"Other", -infinity, infinity}};
    CHECK(f.shown() == Shown{false, true, true, true, true});
    f.style.filters = {{"nobody has it", 5, 6}};
    CHECK(f.shown() == Shown(5, true));
    f.style.filters.clear();
    f.style.colourMode = ColourMode::attribute;
    f.style.attribute = "Range";
    f.style.attributeRange = {0.3, 1};
    CHECK((*f.paint()->words)[3] == plainColourWord);
    CHECK((*f.paint()->words)[0] == gradientTable(GradientName::viridis).front());
    CHECK((*f.paint()->words)[4] == gradientTable(GradientName::viridis).back());
}

TEST_CASE("the first of several components is shown") {
    Fixture f(2);
    Attribute several{"Vector", AttributeType::u8, 3};
    f.schema.attributes.push_back(several);
    f.columns.push_back(std::make_shared<NodeColumns>(NodeColumns{2, {{0, 3}}, {0, 9, 9, 10, 9, 9}}));
    f.style.filters = {{"Vector", 5, 10}};
    CHECK(f.shown() == Shown{false, true});
}

TEST_CASE("levels are of nodes, or with continuous detail of points") {
    Fixture f(100);
    f.style.colourMode = ColourMode::level;
    f.style.gradient = GradientName::grey;
    f.style.levelRange = {3, 4};
    auto paint = f.paint();
    CHECK((*paint->words)[0] == (*paint->words)[99]);
    CHECK(((*paint->words)[0] & 255) == 255);
    f.continuous = true; // level 4 holds what is finer than level 3, up to level 4
    paint = f.paint();
    CHECK(((*paint->words)[0] & 255) < 10);
    CHECK(((*paint->words)[50] & 255) == Approx(255 * std::log2(1 + 3 * 0.505) / 2).margin(2));
    CHECK(((*paint->words)[99] & 255) > 250);

    // A leaf twelve times as dense as a node of its level would be: its points are of finer levels.
    f.style.levelRange = {3, 6};
    f.density.step *= 12;
    paint = f.paint();
    CHECK(((*paint->words)[0] & 255) < 10);
    CHECK(((*paint->words)[50] & 255) == Approx(255 * std::log2(1 + 0.015 + 36 * 0.5) / 6).margin(2));
    CHECK(((*paint->words)[99] & 255) == Approx(255 * std::log2(1 + 0.015 + 36 * 0.99) / 6).margin(2));
}

TEST_CASE("heights are exact far from the origin") {
    Fixture f(3); // z = 0, 5, 10
    f.grid.offset.z = 1e12;
    f.style.colourMode = ColourMode::elevation;
    f.style.gradient = GradientName::grey;
    f.style.elevationRange = {1e12, 1e12 + 10};
    auto paint = f.paint();
    CHECK(((*paint->words)[0] & 255) == 0);
    CHECK(((*paint->words)[1] & 255) == Approx(127.5).margin(1));
    CHECK(((*paint->words)[2] & 255) == 255);
}

TEST_CASE("a mix weighs its colours, without those the cloud lacks") {
    Fixture f(1);
    f.node.colourWords = {0xFF000000u + 200};
    f.addColumn<std::uint8_t>({"Intensity", AttributeType::u8}, {255});
    f.style.gradient = GradientName::grey;
    f.style.colourMode = ColourMode::mix;
    f.style.mix = {{ColourMode::rgb, "", {}, 3}, {ColourMode::intensity, "", {0, 255}, 1}};
    CHECK((*f.paint()->words)[0] == (0xFF000000u | 64u << 16 | 64u << 8 | 214u)); // (3 · 200 + 255) / 4
    f.style.mix.push_back({ColourMode::gpsTime, "", {}, 100});
    CHECK(((*f.paint()->words)[0] & 255) == 214);
    f.style.mix = {{ColourMode::gpsTime, "", {}, 1}};
    CHECK((*f.paint()->words)[0] == plainColourWord);
}

TEST_CASE("clip boxes hide and tint points by where the grid puts them") {
    Fixture f(5); // x = 0, 5, 10, 15, 20
    f.style.clipBoxes = {{{10, 1.5, 10}, {5, 1, 5}}};
    CHECK(f.shown() == Shown{false, true, true, true, false});
    f.style.clipBoxes[0].mode = ClipMode::hideInside;
    CHECK(f.shown() == Shown{true, false, false, false, true});
    f.style.clipBoxes[0].mode = ClipMode::highlight;
    f.style.highlight = {255, 0, 0};
    auto paint = f.paint();
    CHECK(paint->hidden == 0);
    CHECK((*paint->words)[0] == plainColourWord);
    CHECK((*paint->words)[1] == 0xFF5A5AD9u); // half of each channel: (255 + 180) / 2 = 217, 90, 90
    f.style.clipBoxes[0].centre.x = 1000;
    CHECK_FALSE(f.paint());
    f.style.clipBoxes[0].mode = ClipMode::hideOutside;
    CHECK(f.paint()->hidden == 5);
}

TEST_CASE("clip regions hide and tint points by where the grid puts them") {
    Fixture f(5); // x = 0, 5, 10, 15, 20
    f.style.clipRegions.resize(1);
    ClipRegion& clip = f.style.clipRegions[0];
    clip.shape.rings = {{{5, -9}, {15, -9}, {15, 9}, {5, 9}}}; // edges through points
    CHECK(f.shown() == Shown{false, true, true, true, false});
    clip.mode = ClipMode::hideInside;
    CHECK(f.shown() == Shown{true, false, false, false, true});
    clip.mode = ClipMode::highlight;
    f.style.highlight = {255, 0, 0};
    auto paint = f.paint();
    CHECK(paint->hidden == 0);
    CHECK((*paint->words)[0] == plainColourWord);
    CHECK((*paint->words)[1] == 0xFF5A5AD9u);
    for (Point2d& corner : clip.shape.rings[0])
        corner.x += 1000;
    CHECK_FALSE(f.paint());
    clip.mode = ClipMode::hideOutside;
    CHECK(f.paint()->hidden == 5);
}

TEST_CASE("exact colours are taken where the node is to show them") {
    Fixture f(2);
    f.node.colourWords = {0xFF010101u, 0xFF020202u};
    ByteWriter words;
    words.write(0xFF0A0B0Cu);
    words.write(0xFF0D0E0Fu);
    f.columns.push_back(std::make_shared<NodeColumns>(NodeColumns{2, {{exactColourWords, 4}}, words.take()}));
    CHECK_FALSE(f.paint());
    f.exact = true;
    CHECK(*f.paint()->words == std::vector<std::uint32_t>{0xFF0A0B0Cu, 0xFF0D0E0Fu});
    f.schema.attributes.push_back({"Red", AttributeType::u16});
    f.style.filters = {{"Red", 0, 12 * 256}};
    CHECK(f.shown() == Shown{true, false});
}
