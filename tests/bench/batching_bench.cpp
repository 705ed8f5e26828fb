// Adaptive sizes by the octree texture against dynamic batching (point_batches.hpp), along a camera path:
//
//   batching_bench CLOUD.stipple [PATH, fly-over] [FRAMES, 60] [MILLIONS of points, 2] [ROUNDS, 5]
//
// 1280 × 720, the style's adaptive sizes, no lighting. Prints what each frame's preparation takes, what is
// uploaded, drawn and kept, how long frames take (rounds interleaved, so ratios hold on a busy machine), and
// how far pictures are from the reference and from each other. Ends with 1 if a point has another size or is
// drawn twice or not at all.
#include "client/bench/camera_path.hpp"
#include "client/bench/statistics.hpp"
#include "client/core/frame_planner.hpp"
#include "client/headless/egl_context.hpp"
#include "client/measure/pixel_error.hpp"
#include "client/reference/render_cloud.hpp"
#include "client/render/drawn_octree.hpp"
#include "client/render/software_renderer.hpp"
#include "shared/io/file_source.hpp"
#include "tests/bench/adaptive_drawer.hpp"
#include "tests/bench/settled_viewer.hpp"
#include "tests/bench/sized_points.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>

using namespace stipple;
using bench::meanOf;
using bench::median;

namespace {

constexpr int width = 1280, height = 720, judgedFrames = 4;

double seconds(const std::function<void()>& work) {
    auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Style adaptiveStyle() {
    Style style;
    style.sizeMode = PointSizeMode::adaptive;
    style.edl.enabled = false;
    return style;
}

struct Flight {
    std::vector<Camera> cameras;
    std::vector<FramePlan> plans;
    std::shared_ptr<const CloudMetadata> metadata;
};

Flight flightOver(const std::string& cloud, const std::string& path, int frames, std::uint64_t budget) {
    SettledViewer viewer(cloud, width, height);
    Flight flight;
    flight.metadata = std::make_shared<const CloudMetadata>(viewer.metadata());
    flight.cameras = need(bench::builtInPath(path, viewer.metadata().worldBounds(), frames)).cameras;
    for (const Camera& camera : flight.cameras)
        flight.plans.push_back(viewer.plan(camera, adaptiveStyle(), budget, 60));
    return flight;
}

// --- preparation -----------------------------------------------------------------------------------------

// Points that were not among those of the frames before, as far back as lists are kept.
class NewPoints {
  public:
    double in(const FramePlan& plan) {
        ++frame_;
        double points = 0;
        for (const DrawNode& node : plan.nodes) {
            std::uint64_t& last = last_[{node.node->id, node.colourId()}];
            if (last == 0 || last + 30 < frame_)
                points += node.node->pointCount;
            last = frame_;
        }
        return points;
    }

  private:
    std::map<std::pair<std::uint64_t, std::uint64_t>, std::uint64_t> last_;
    std::uint64_t frame_ = 0;
};

struct Preparation {
    std::vector<double> walkSeconds, batchSeconds; // per frame, the best of the rounds
    std::vector<double> walkPoints, walkWords, batchPoints, lists;
    std::vector<double> nodes, points, batchCalls, vertices, listCalls, listVertices, added, bytes;
    std::vector<double> seenCalls, seenVertices; // without unseen octants
};

void keepLeast(std::vector<double>& least, std::size_t at, double value) {
    if (at >= least.size())
        least.push_back(value);
    least[at] = std::min(least[at], value);
}

Preparation prepare(const Flight& flight, int rounds) {
    Preparation found;
    for (int round = 0; round < rounds; ++round) {
        PointBatches batches, seen(true);
        NewPoints fresh;
        DrawnOctree last;
        for (std::size_t i = 0; i < flight.plans.size(); ++i) {
            const FramePlan& plan = flight.plans[i];
            DrawnOctree tree;
            keepLeast(found.walkSeconds, i, seconds([&] { tree = drawnOctree(plan); }));
            keepLeast(found.batchSeconds, i, seconds([&] { batches.update(plan); }));
            if (round > 0)
                continue;
            seen.update(plan);
            const BatchCounters& counted = batches.counters();
            found.walkPoints.push_back(fresh.in(plan));
            found.walkWords.push_back(tree.words == last.words ? 0 : static_cast<double>(tree.words.size()));
            found.batchPoints.push_back(static_cast<double>(counted.pointsMade));
            found.lists.push_back(static_cast<double>(counted.listsMade));
            found.nodes.push_back(static_cast<double>(drawOrder(plan).size()));
            found.points.push_back(static_cast<double>(counted.ownPoints));
            found.batchCalls.push_back(static_cast<double>(counted.drawCalls));
            found.vertices.push_back(static_cast<double>(counted.vertices));
            found.listCalls.push_back(static_cast<double>(counted.listCalls));
            found.listVertices.push_back(static_cast<double>(counted.listVertices));
            found.added.push_back(
                100 * (static_cast<double>(counted.listPoints) / static_cast<double>(counted.ownPoints) - 1));
            found.bytes.push_back(static_cast<double>(counted.bytes));
            found.seenCalls.push_back(static_cast<double>(seen.counters().drawCalls));
            found.seenVertices.push_back(static_cast<double>(seen.counters().vertices));
            last = std::move(tree);
        }
    }
    return found;
}

double most(const std::vector<double>& values) {
    return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

// The first frame has everything to make; it is no frame of a moving camera.
std::vector<double> withoutFirst(std::vector<double> values) {
    if (values.size() > 1)
        values.erase(values.begin());
    return values;
}

// Seconds that a moving frame's preparation takes, in the mean.
struct Moving {
    double walk = 0, batch = 0;
};

void print(const Preparation& p) {
    std::vector<double> walk = withoutFirst(p.walkSeconds), batch = withoutFirst(p.batchSeconds);
    std::printf("| a frame of the moving camera | octree texture | batches |\n|---|---|---|\n");
    std::printf("| preparation, ms: median, mean, most | %.3f, %.3f, %.3f | %.3f, %.3f, %.3f |\n",
                1e3 * median(walk), 1e3 * meanOf(walk), 1e3 * most(walk), 1e3 * median(batch),
                1e3 * meanOf(batch), 1e3 * most(batch));
    std::printf("| lists made | | %.1f |\n", meanOf(withoutFirst(p.lists)));
    std::printf("| points uploaded, mean | %.0f | %.0f |\n", meanOf(withoutFirst(p.walkPoints)),
                meanOf(withoutFirst(p.batchPoints)));
    std::printf("| words of the tree uploaded, mean | %.0f | |\n", meanOf(withoutFirst(p.walkWords)));
    std::printf("| draw calls (a call a list; without unseen octants) | %.0f | %.0f (%.0f; %.0f) |\n",
                meanOf(p.nodes), meanOf(p.batchCalls), meanOf(p.listCalls), meanOf(p.seenCalls));
    std::printf("| vertices (a call a list; without unseen octants) | %.0f | %.0f (%.0f; %.0f) |\n",
                meanOf(p.points), meanOf(p.vertices), meanOf(p.listVertices), meanOf(p.seenVertices));
    std::printf("| points kept more than drawn nodes have | | %.1f %% (at most %.1f %%) |\n", meanOf(p.added),
                most(p.added));
    std::printf("| memory of lists | | %.1f MB |\n", most(p.bytes) / 1e6);
}

// --- sizes -----------------------------------------------------------------------------------------------

// Of every fifth frame; the batches go along with all.
bool checkSizes(const Flight& flight) {
    PointBatches batches;
    std::uint64_t points = 0, wrong = 0;
    for (std::size_t i = 0; i < flight.plans.size(); ++i) {
        batches.update(flight.plans[i]);
        if (i % 5 != 0)
            continue;
        std::vector<SizedPoint> walked = sizedByWalk(flight.plans[i]), batched = sizedByBatches(batches);
        points += walked.size();
        std::vector<SizedPoint> apart;
        std::set_symmetric_difference(walked.begin(), walked.end(), batched.begin(), batched.end(),
                                      std::back_inserter(apart));
        wrong += apart.size();
    }
    std::printf("\nSizes of %llu points: %llu differ\n", static_cast<unsigned long long>(points),
                static_cast<unsigned long long>(wrong));
    return wrong == 0 && points > 0;
}

// --- frames ----------------------------------------------------------------------------------------------

struct Judged {
    std::vector<double> glesRatios, seenRatios, softwareRatios; // batches over octree texture
    std::vector<double> glesWhole, softwareWhole;               // with a moving frame's preparation
    std::vector<double> walkErrors, batchErrors, apart, glesApart, seenApart;
    std::vector<double> walkBytes, batchBytes;
};

std::vector<std::size_t> judgedOf(const Flight& flight) {
    std::vector<std::size_t> frames;
    for (int i = 0; i < judgedFrames; ++i)
        frames.push_back(flight.plans.size() * static_cast<std::size_t>(2 * i + 1) / (2 * judgedFrames));
    return frames;
}

std::vector<DepthImage> referencesOf(const Flight& flight, const std::string& cloud) {
    std::vector<reference::Job> jobs;
    for (std::size_t frame : judgedOf(flight))
        jobs.push_back(
            {reference::viewOf(flight.cameras[frame], width, height, flight.metadata->worldBounds()),
             resolvedStyle(adaptiveStyle(), std::vector{flight.metadata}), 1});
    auto source = need(openFileSource(cloud));
    return need(renderCloud(*source, jobs));
}

void judgeSoftware(const FramePlan& plan, const PointBatches& batches, const Image& wanted,
                   const Moving& moving, int rounds, Judged& judged) {
    auto renderer = SoftwareRenderer::create(1);
    FramePlan walked = plan, batched = planOfRuns(batches);
    Image walkedPicture = renderer->render(walked), batchedPicture = renderer->render(batched);
    judged.walkErrors.push_back(measure::pixelError(wanted, walkedPicture).mean);
    judged.batchErrors.push_back(measure::pixelError(wanted, batchedPicture).mean);
    judged.apart.push_back(
        static_cast<double>(measure::pixelError(walkedPicture, batchedPicture, 0).differing));
    for (int round = 0; round < rounds; ++round) {
        double octree = seconds([&] { renderer->render(walked); });
        double batch = seconds([&] { renderer->render(batched); });
        judged.softwareRatios.push_back(batch / octree);
        judged.softwareWhole.push_back((batch + moving.batch) / (octree + moving.walk));
    }
}

void judgeGles(headless::EglContext& context, const FramePlan& plan, const PointBatches& batches,
               const PointBatches& seen, const Moving& moving, int rounds, Judged& judged) {
    unsigned target = need(context.framebuffer(width, height));
    AdaptiveDrawer octree, batch, seenBatch;
    auto octreeFrame = [&] {
        need(octree.drawByOctree(plan, target));
        glFinish();
    };
    auto batchFrame = [&](AdaptiveDrawer& drawer, const PointBatches& of) {
        need(drawer.drawBatches(of, target));
        glFinish();
    };
    octreeFrame();
    Image walked = need(context.read());
    batchFrame(batch, batches);
    judged.glesApart.push_back(
        static_cast<double>(measure::pixelError(walked, need(context.read()), 0).differing));
    batchFrame(seenBatch, seen);
    judged.seenApart.push_back(
        static_cast<double>(measure::pixelError(walked, need(context.read()), 0).differing));
    judged.walkBytes.push_back(static_cast<double>(octree.gpuBytes()));
    judged.batchBytes.push_back(static_cast<double>(batch.gpuBytes()));
    for (int round = 0; round < rounds; ++round) {
        double first = seconds(octreeFrame);
        double second = seconds([&] { batchFrame(batch, batches); });
        judged.glesRatios.push_back(second / first);
        judged.glesWhole.push_back((second + moving.batch) / (first + moving.walk));
        judged.seenRatios.push_back(seconds([&] { batchFrame(seenBatch, seen); }) / first);
    }
}

void print(const Judged& j, const char* driver) {
    auto line = [](const char* what, const std::vector<double>& ratios) {
        if (ratios.empty())
            return;
        bench::Spread spread = bench::spreadOf(ratios);
        std::printf("| %s: time of a frame over that of the octree texture | %.3f (%.3f-%.3f) |\n", what,
                    spread.median, spread.least, spread.most);
    };
    std::printf("\n| batches, %d frames of the path | |\n|---|---|\n", judgedFrames);
    line(driver, j.glesRatios);
    line("… with the preparation of a moving frame (mean)", j.glesWhole);
    line("… without unseen octants", j.seenRatios);
    line("software, one thread", j.softwareRatios);
    line("… with the preparation of a moving frame (mean)", j.softwareWhole);
    if (!j.glesRatios.empty()) {
        std::printf("| pixels that differ from the octree texture's, of %d | %.1f |\n", width * height,
                    meanOf(j.glesApart));
        std::printf("| … without unseen octants | %.1f |\n", meanOf(j.seenApart));
        std::printf("| GPU memory, MB: octree texture, batches | %.1f, %.1f |\n", meanOf(j.walkBytes) / 1e6,
                    meanOf(j.batchBytes) / 1e6);
    }
    std::printf("| software: pixels that differ | %.1f |\n", meanOf(j.apart));
    std::printf("| mean error against the reference, levels: octree texture, batches | %.3f, %.3f |\n",
                meanOf(j.walkErrors), meanOf(j.batchErrors));
}

} // namespace

int main(int argc, char** argv) {
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
    auto word = [&](int at, const char* otherwise) { return argc > at ? argv[at] : otherwise; };
    int frames = std::atoi(word(3, "60")), rounds = std::atoi(word(5, "5"));
    double million = std::atof(word(4, "2"));
    if (argc < 2 || frames < judgedFrames || rounds < 1 || !(million > 0)) {
        std::fprintf(stderr,
                     "batching_bench CLOUD.stipple [PATH] [FRAMES, at least %d] [MILLIONS] [ROUNDS]\n",
                     judgedFrames);
        return 2;
    }
    std::string cloud = argv[1];
    Flight flight = flightOver(cloud, word(2, "fly-over"), frames, static_cast<std::uint64_t>(1e6 * million));
    std::printf("%s, %s of %d frames, %.1f M points\n\n", cloud.c_str(), word(2, "fly-over"), frames,
                million);
    Preparation preparation = prepare(flight, rounds);
    print(preparation);
    Moving moving{meanOf(withoutFirst(preparation.walkSeconds)),
                  meanOf(withoutFirst(preparation.batchSeconds))};
    bool right = checkSizes(flight);

    auto context = headless::EglContext::create();
    std::vector<DepthImage> references = referencesOf(flight, cloud);
    Judged judged;
    std::vector<std::size_t> at = judgedOf(flight);
    for (std::size_t i = 0; i < at.size(); ++i) {
        const FramePlan& plan = flight.plans[at[i]];
        PointBatches batches, seen(true);
        batches.update(plan);
        seen.update(plan);
        judgeSoftware(plan, batches, references[i].image, moving, rounds, judged);
        if (context.ok())
            judgeGles(**context, plan, batches, seen, moving, rounds, judged);
    }
    print(judged, context.ok() ? (*context)->driver().c_str() : "no OpenGL ES");
    return right ? 0 : 1;
}
