#include "client/core/view_counter.hpp"

#include "client/core/json.hpp"
#include "client/core/view_session.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/memory_source.hpp"
#include "tests/support/scripted_source.hpp"
#include "tests/support/small_cloud.hpp"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

using namespace stipple;
using namespace stipple::test;

namespace {

constexpr int width = 800, height = 600;

struct Counted {
    std::unique_ptr<NodeDecoder> decoder = makeInlineDecoder();
    std::unique_ptr<ViewSession> session;
    std::shared_ptr<SourceScript> script = std::make_shared<SourceScript>();

    explicit Counted(const SmallCloud& cloud) {
        SessionLimits limits;
        limits.minNodePixels = 1;
        session = ViewSession::create(*decoder, limits);
        session->setViewport(width, height);
        script->file = cloud.file;
        session->addCloud(std::make_unique<ScriptedSource>(script), "small");
    }

    void settle() {
        for (int i = 0; i < 500 && !session->settled(); ++i)
            session->update();
        REQUIRE(session->settled());
    }

    ViewCounts count(const std::vector<HistogramRequest>& requests, std::uint64_t atOnce = 1'000'000) {
        ViewCounter counter(session->countedView(), requests);
        int calls = 0;
        while (!counter.advance(atOnce))
            REQUIRE(++calls < 100'000);
        return counter.counts();
    }
    // Once all that they look at is here.
    ViewCounts watch(const std::vector<HistogramRequest>& requests) {
        session->watchAttributes(attributesOf(requests));
        settle();
        return count(requests);
    }
};

const SmallCloud& cloud() {
    static SmallCloud made = makeSmallCloud({.levels = 3, .pointsPerNode = 1000, .withClasses = true});
    return made;
}

// Every point of the file, read without a session.
struct Point {
    Vec3d world;
    std::map<std::string, double> values;
};
std::vector<Point> pointsOf(const SmallCloud& cloud) {
    MemorySource source(cloud.file);
    auto reader = CloudReader::open(source);
    REQUIRE(reader.ok());
    const CloudMetadata& metadata = (*reader)->metadata();
    std::vector<Point> points;
    Status visited = (*reader)->visitNodes([&](const NodeEntry& entry) -> Status {
        STIPPLE_TRY(batch, (*reader)->readNode(entry));
        for (std::size_t i = 0; i < batch.size(); ++i) {
            Point point{metadata.grid.toWorld(batch.positions[i]), {}};
            for (std::size_t a = 0; a < metadata.schema.attributes.size(); ++a) {
                const Attribute& attribute = metadata.schema.attributes[a];
                int at = static_cast<int>(a);
                point.values[attribute.name] = attribute.size() == 1 ? batch.value<std::uint8_t>(at, i)
                                                                     : batch.value<std::uint16_t>(at, i);
            }
            points.push_back(point);
        }
        return {};
    });
    REQUIRE(visited.ok());
    return points;
}

// Pinhole arithmetic of its own. Fails for points so near to an edge of the picture that rounding would
// decide.
bool isSeen(const Camera& camera, Vec3d world) {
    Vec3d forward = normalized(camera.target - camera.position);
    Vec3d right = normalized(cross(forward, camera.up)), up = cross(right, forward);
    Vec3d from = world - camera.position;
    double depth = dot(from, forward), half = std::tan(camera.fovYDegrees * 3.14159265358979323846 / 360);
    double halfHeight = camera.projection == Projection::orthographic ? camera.orthoHeight / 2 : depth * half;
    double x = dot(from, right) / halfHeight * height / width, y = dot(from, up) / halfHeight;
    if (std::abs(std::abs(x) - 1) < 1e-9 || std::abs(std::abs(y) - 1) < 1e-9)
        FAIL("a point lies on the picture's edge: take another camera");
    return (camera.projection == Projection::orthographic || depth > 0) && std::abs(x) < 1 && std::abs(y) < 1;
}

Camera inside(const SmallCloud& cloud, Projection projection = Projection::perspective) {
    BoxD box = cloud.metadata.worldBounds();
    Vec3d size = box.max - box.min;
    Camera camera;
    camera.projection = projection;
    camera.position = box.min + Vec3d{size.x * 0.31, size.y * 0.12, size.z * 0.83};
    camera.target = box.min + Vec3d{size.x * 0.47, size.y * 0.55, size.z * 0.21};
    camera.orthoHeight = size.y * 0.37;
    return camera;
}

using Shows = std::function<bool(const Point&)>;
std::vector<double> valuesInView(const SmallCloud& cloud, const Camera& camera, const std::string& name,
                                 const Shows& shows) {
    std::vector<double> values;
    for (const Point& point : pointsOf(cloud))
        if (isSeen(camera, point.world) && shows(point))
            values.push_back(name == "z" ? point.world.z : point.values.at(name));
    return values;
}
bool all(const Point&) {
    return true;
}

void checkAgainst(const Histogram& histogram, const std::vector<double>& values) {
    REQUIRE(values.size() > 100);
    CHECK(histogram.points == values.size());
    std::vector<std::uint64_t> bins(histogram.bins.size());
    std::uint64_t below = 0, above = 0;
    const Range& range = histogram.range;
    double sum = 0, squares = 0;
    for (double value : values) {
        sum += value;
        double at =
            std::floor((value - range.min) / (range.max - range.min) * static_cast<double>(bins.size()));
        if (value < range.min)
            ++below;
        else if (value > range.max)
            ++above;
        else
            ++bins[std::min(static_cast<std::size_t>(at), bins.size() - 1)];
    }
    CHECK(histogram.bins == bins);
    CHECK(histogram.below == below);
    CHECK(histogram.above == above);
    CHECK(histogram.min == *std::min_element(values.begin(), values.end()));
    CHECK(histogram.max == *std::max_element(values.begin(), values.end()));
    double mean = sum / static_cast<double>(values.size());
    for (double value : values)
        squares += (value - mean) * (value - mean);
    CHECK(histogram.mean == Approx(mean).epsilon(1e-12));
    CHECK(histogram.deviation ==
          Approx(std::sqrt(squares / static_cast<double>(values.size()))).epsilon(1e-12));
}

const HistogramRequest heights{ColourMode::elevation, "", 50, {}};
const HistogramRequest intensities{ColourMode::intensity, "", 64, {}};
const HistogramRequest sources{ColourMode::attribute, "point source id", 32, Range{1000, 30000}};
const HistogramRequest classes{ColourMode::classification, "", 256, Range{-0.5, 255.5}};

} // namespace

TEST_CASE("histograms count every point in view once, as going through the file does") {
    for (Projection projection : {Projection::perspective, Projection::orthographic}) {
        Counted counted(cloud());
        Camera camera = inside(cloud(), projection);
        counted.session->setCamera(camera);
        ViewCounts counts = counted.watch({heights, intensities, sources, classes});
        CHECK(counts.nodesMissing == 0);
        CHECK(counts.nodes == counted.session->plan().nodes.size());
        CHECK(counts.points == valuesInView(cloud(), camera, "z", all).size());
        CHECK(counts.points < cloud().metadata.pointCount);
        checkAgainst(counts.histograms[0], valuesInView(cloud(), camera, "z", all));
        checkAgainst(counts.histograms[1], valuesInView(cloud(), camera, "Intensity", all));
        checkAgainst(counts.histograms[2], valuesInView(cloud(), camera, "Point Source ID", all));
        checkAgainst(counts.histograms[3], valuesInView(cloud(), camera, "Classification", all));
        CHECK(counts.histograms[2].below > 0);
        CHECK(counts.histograms[2].above > 0);
    }
}

TEST_CASE("counting bit by bit gives the same as at once") {
    Counted counted(cloud());
    counted.session->setCamera(inside(cloud()));
    std::vector<HistogramRequest> requests{heights, intensities, classes};
    ViewCounts whole = counted.watch(requests), pieces = counted.count(requests, 1);
    for (std::size_t i = 0; i < requests.size(); ++i)
        CHECK(whole.histograms[i].bins == pieces.histograms[i].bins);
    CHECK(whole.points == pieces.points);
}

TEST_CASE("bins of whole numbers hold equally many of them, and one value alone has a bin") {
    Counted counted(cloud());
    counted.session->setCamera(inside(cloud()));
    ViewCounts counts = counted.watch({{ColourMode::classification, "", 100, {}}, intensities});
    const Histogram& few = counts.histograms[0];
    double each = (few.range.max - few.range.min) / static_cast<double>(few.bins.size());
    CHECK(few.range.min == few.min - 0.5);
    CHECK(each == std::round(each));
    CHECK(few.bins.size() <= 100);
    CHECK(few.range.max >= few.max + 0.5);
    CHECK(few.range.max - each < few.max);

    SmallCloud point = makeSmallCloud({.levels = 1, .pointsPerNode = 1});
    Counted one(point);
    one.session->setCamera(namedCamera(NamedView::top, point.metadata.worldBounds(), 800.0 / 600));
    ViewCounts alone = one.watch({heights, intensities});
    CHECK(alone.histograms[0].bins == std::vector<std::uint64_t>{1});
    CHECK(alone.histograms[1].bins == std::vector<std::uint64_t>{1});
    CHECK(alone.histograms[0].deviation == 0);
}

TEST_CASE("filters, hidden classes and clip boxes count, but not on the attribute itself") {
    Counted counted(cloud());
    Camera camera = inside(cloud());
    Style style;
    style.filters = {{"Intensity", 5000, 40000}, {"Point Source ID", 20000, HUGE_VAL}};
    for (std::size_t c = 0; c < 60; ++c)
        style.hiddenClasses.set(c);
    BoxD box = cloud().metadata.worldBounds();
    Vec3d middle = (box.min + box.max) * 0.5, size = box.max - box.min;
    ClipBox clip;
    clip.centre = middle;
    clip.halfSize = {size.x * 0.3, size.y * 0.26, size.z * 0.4};
    style.clipBoxes = {clip};
    counted.session->setStyle(style);
    counted.session->setCamera(camera);
    ViewCounts counts = counted.watch({heights, intensities, classes});

    auto clipped = [&](const Point& point) {
        Vec3d from = point.world - clip.centre;
        return std::abs(from.x) <= clip.halfSize.x && std::abs(from.y) <= clip.halfSize.y &&
               std::abs(from.z) <= clip.halfSize.z;
    };
    auto intensity = [](const Point& p) {
        return p.values.at("Intensity") >= 5000 && p.values.at("Intensity") <= 40000;
    };
    auto source = [](const Point& p) { return p.values.at("Point Source ID") >= 20000; };
    auto classShown = [](const Point& p) { return p.values.at("Classification") >= 60; };
    checkAgainst(counts.histograms[0], valuesInView(cloud(), camera, "z", [&](const Point& p) {
                     return clipped(p) && intensity(p) && source(p) && classShown(p);
                 }));
    checkAgainst(counts.histograms[1], valuesInView(cloud(), camera, "Intensity", [&](const Point& p) {
                     return clipped(p) && source(p) && classShown(p);
                 }));
    checkAgainst(counts.histograms[2], valuesInView(cloud(), camera, "Classification", [&](const Point& p) {
                     return clipped(p) && intensity(p) && source(p);
                 }));
    CHECK(counts.points == valuesInView(cloud(), camera, "z", clipped).size());
}

TEST_CASE("what is counted is fetched beside the picture, once, and only while it is watched") {
    Counted counted(cloud());
    counted.session->setCamera(inside(cloud()));
    counted.settle();
    std::uint64_t before = counted.session->counters().attributeBytesFetched;
    std::uint64_t drawn = counted.session->plan().counters.pointsDrawn;
    ViewCounts missing = counted.count({intensities});
    CHECK(missing.nodesMissing == missing.nodes); // nothing is watched yet
    CHECK(missing.histograms[0].points == 0);

    counted.session->watchAttributes({"Intensity", "no such attribute"});
    counted.script->holdAnswers = true;
    counted.session->update();
    counted.session->update();
    CHECK(counted.session->plan().counters.pointsDrawn == drawn); // the picture does not wait
    CHECK(counted.count({intensities}).nodesMissing > 0);
    counted.script->holdAnswers = false;
    counted.settle();
    CHECK(counted.count({intensities}).nodesMissing == 0);
    std::uint64_t fetched = counted.session->counters().attributeBytesFetched - before;
    CHECK(fetched > 0);
    counted.session->watchAttributes({});
    counted.settle();
    counted.session->watchAttributes({"Intensity"});
    counted.settle();
    CHECK(counted.session->counters().attributeBytesFetched - before == fetched);
}

TEST_CASE("intensities of inner nodes are the points' own, where their file shows means") {
    SmallCloud means = makeSmallCloud({.levels = 2,
                                       .pointsPerNode = 1000,
                                       .colour = PictureColour::intensity,
                                       .innerColour = InnerColour::mean});
    Counted counted(means);
    Camera camera = inside(means);
    counted.session->setCamera(camera);
    counted.settle();
    CHECK(counted.count({intensities}).histograms[0].coarse > 0);
    ViewCounts counts = counted.watch({intensities});
    CHECK(counts.histograms[0].coarse == 0);
    checkAgainst(counts.histograms[0], valuesInView(means, camera, "Intensity", all));
}

TEST_CASE("a cloud without the attribute has points without values; an empty view has none") {
    Counted counted(cloud());
    counted.session->setCamera(inside(cloud()));
    HistogramRequest times{ColourMode::gpsTime, "", 10, {}};
    ViewCounts counts = counted.watch({times});
    CHECK(counts.histograms[0].points == 0);
    CHECK(counts.histograms[0].bins.empty());
    CHECK(counts.histograms[0].without == counts.points);

    Camera away;
    away.position = cloud().metadata.worldBounds().max + Vec3d{1000, 1000, 1000};
    away.target = away.position + Vec3d{10, 10, 1};
    counted.session->setCamera(away);
    ViewCounts nothing = counted.watch({times, heights});
    CHECK(nothing.points == 0);
    CHECK(nothing.histograms[1].bins.empty());
}

TEST_CASE("requests and counts are JSON") {
    auto requests = histogramRequestsFromJson(
        R"([{"colourMode": "intensity"}, {"colourMode": "attribute", "attribute": "Scan Angle", "bins": 9, "range": [1, 2]}])");
    REQUIRE(requests.ok());
    CHECK((*requests)[0] == HistogramRequest{ColourMode::intensity, "", 64, {}});
    CHECK((*requests)[1] == HistogramRequest{ColourMode::attribute, "Scan Angle", 9, Range{1, 2}});
    for (const char* wrong :
         {"{}", R"([{"colourMode": "rgb"}])", R"([{"colourMode": "mix"}])",
          R"([{"colourMode": "attribute"}])", R"([{"colourMode": "intensity", "bins": 0}])",
          R"([{"colourMode": "intensity", "size": 1}])", "["})
        CHECK_FALSE(histogramRequestsFromJson(wrong).ok());

    Counted counted(cloud());
    counted.session->setCamera(inside(cloud()));
    nlohmann::json json = toJson(counted.watch({heights}));
    CHECK(json["nodesMissing"] == 0);
    CHECK(json["histograms"][0]["bins"].size() == 50);
    CHECK(json["histograms"][0]["range"].size() == 2);
}
