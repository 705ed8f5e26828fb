// How evenly points lie in a picture, from a real conversion: a plane seen along the ground, through many
// levels. With s the target spacing at a distance, points per area times s² should be the same number
// everywhere.
#include "client/core/camera.hpp"
#include "client/core/continuous_detail.hpp"
#include "client/core/point_query.hpp"
#include "client/core/view_session.hpp"
#include "client/headless/session_loader.hpp"
#include "client/headless/thread_decoder.hpp"
#include "converter/build/convert.hpp"
#include "shared/io/file_source.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_plan.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace stipple;
using namespace stipple::test;

namespace {

constexpr double side = 400, eyeHeight = 4, binsPerOctave = 4;
constexpr int width = 800, height = 600;

std::string planeCloud(const TemporaryFolder& folder, std::uint32_t points) {
    std::string text = folder.path() + "/plane.xyz", cloud = folder.path() + "/plane.stipple";
    std::FILE* file = std::fopen(text.c_str(), "w");
    REQUIRE(file);
    TestRandom random(5);
    for (std::uint32_t i = 0; i < points; ++i)
        std::fprintf(file, "%.3f %.3f 0\n", random.unit() * side, random.unit() * side);
    std::fclose(file);
    auto converted = convertFiles({text}, cloud, {}, [](const std::string&, std::uint64_t, std::uint64_t) {});
    REQUIRE(converted.ok());
    return cloud;
}

// Points per area times the square of the target spacing, by octaves of the distance; empty bins are left
// out.
struct Densities {
    std::vector<double> bins;
    std::uint64_t points = 0;

    double mean() const {
        double sum = 0;
        for (double bin : bins)
            sum += bin;
        return sum / static_cast<double>(bins.size());
    }
    // The largest relative difference from the mean.
    double deviation() const {
        double most = 0;
        for (double bin : bins)
            most = std::max(most, std::abs(bin / mean() - 1));
        return most;
    }
    // The largest ratio of one bin to the next.
    double seam() const {
        double most = 1;
        for (std::size_t i = 0; i + 1 < bins.size(); ++i)
            most = std::max({most, bins[i] / bins[i + 1], bins[i + 1] / bins[i]});
        return most;
    }
};

class Scene {
  public:
    explicit Scene(const std::string& cloud)
        : decoder_(makeThreadDecoder(2)), session_(ViewSession::create(*decoder_)) {
        auto source = openFileSource(cloud);
        REQUIRE(source.ok());
        session_->setViewport(width, height);
        Camera camera;
        camera.position = {side / 2, 5, eyeHeight};
        camera.target = {side / 2, 6, eyeHeight};
        camera.fovYDegrees = 60;
        session_->setCamera(camera);
        session_->addCloud(std::move(*source), "plane");
        settle([&] { return session_->clouds()[0].stage == CloudStage::ready; });
        metadata_ = session_->clouds()[0].metadata;
    }

    // `from`, `to`: distances between which it is looked at.
    Densities measure(const Style& style, std::uint64_t budget, double targetPixels, double from, double to) {
        SessionLimits limits;
        limits.pointBudget = budget;
        limits.minNodePixels = 0;
        session_->setLimits(limits);
        session_->setStyle(style);
        session_->update();
        settle([&] { return session_->settled(); });
        std::vector<double> counts(static_cast<std::size_t>(std::log2(to / from) * binsPerOctave));
        Densities densities;
        const FramePlan& plan = session_->plan();
        for (const DrawNode& node : plan.nodes)
            count(plan, node, from, counts, densities.points);
        for (std::size_t i = 0; i < counts.size(); ++i)
            densities.bins.push_back(counts[i] * spacingSquared(plan.view, targetPixels, from, i));
        return densities;
    }

    double pixelAt(double distance) const { return pixelWorld(session_->plan().view, height, distance); }

  private:
    void settle(const std::function<bool()>& done) {
        headless::SessionLoader loader(*session_, "plane", std::chrono::seconds(60));
        REQUIRE(loader.until(done).ok());
    }

    void count(const FramePlan& plan, const DrawNode& node, double from, std::vector<double>& counts,
               std::uint64_t& points) const {
        const RankDensity& density = node.density;
        for (std::uint32_t i = 0; i < node.pointCount; ++i) {
            Vec3d at = positionRecord(*metadata_, *node.node, i).position - plan.view.eye;
            double distance = dot(at, plan.view.forward);
            bool inPicture = distance > 0 && std::abs(at.x) <= halfWidth(plan.view, distance);
            double target = plan.detailPixels * pixelAt(std::max(distance, 1e-9));
            bool shows = plan.detailPixels == 0 || (density.base + density.step * i) * target * target < 1;
            if (!inPicture || !shows)
                continue;
            ++points;
            auto bin = static_cast<std::ptrdiff_t>(std::floor(std::log2(distance / from) * binsPerOctave));
            if (bin >= 0 && bin < static_cast<std::ptrdiff_t>(counts.size()))
                ++counts[static_cast<std::size_t>(bin)];
        }
    }

    static double halfWidth(const ViewTransform& view, double distance) {
        return view.tanHalfFovY * view.aspect * distance;
    }
    // The target spacing squared over the bin's area: their quotient does not depend on the distance.
    double spacingSquared(const ViewTransform& view, double pixels, double from, std::size_t bin) const {
        double a = from * std::exp2(static_cast<double>(bin) / binsPerOctave);
        double b = a * std::exp2(1 / binsPerOctave), middle = std::sqrt((a * a + b * b) / 2);
        double area = view.tanHalfFovY * view.aspect * (b * b - a * a);
        double target = pixels * pixelAt(middle);
        return target * target / area;
    }

    std::unique_ptr<NodeDecoder> decoder_;
    std::unique_ptr<ViewSession> session_;
    std::shared_ptr<const CloudMetadata> metadata_;
};

void show(const char* what, const Densities& densities) {
    std::printf("%s: %llu points; density times spacing², by quarters of an octave:", what,
                static_cast<unsigned long long>(densities.points));
    for (double bin : densities.bins)
        std::printf(" %.3f", bin);
    std::printf("; off the mean by at most %.1f %%, from one to the next by %.2f\n",
                100 * densities.deviation(), densities.seam());
}

} // namespace

TEST_CASE("density along a plane follows the target smoothly through all levels") {
    TemporaryFolder folder;
    Scene scene(planeCloud(folder, 1'500'000));
    Style style;
    style.detail.mode = DetailMode::continuous;
    style.detail.spacingPixels = 3;
    // The scan's own density ends the range at its near end; where the view grows wider than the plane, its
    // far.
    double from = 40, to = 227;
    Densities continuous = scene.measure(style, 20'000'000, 3, from, to);
    Densities discrete = scene.measure({}, continuous.points, 3, from, to);
    show("continuous", continuous);
    show("levels", discrete);
    CHECK(continuous.deviation() < 0.05);
    CHECK(continuous.seam() < 1.05);
    CHECK(discrete.deviation() > 5 * continuous.deviation()); // what it is compared with shows its levels
}
