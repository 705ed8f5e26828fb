#include "client/render/software_renderer.hpp"

#include "client/render/drawn_octree.hpp"
#include "client/render/raster_setup.hpp"
#include "client/render/software_points.hpp"
#include "client/render/software_shading.hpp"
#include "client/render/worker_pool.hpp"

#include <algorithm>

namespace stipple {
namespace {

constexpr std::uint32_t runPoints = 16384; // a run is one piece of work: about 100 µs
constexpr int rowsPerPiece = 16;

class CellRenderer final : public SoftwareRenderer {
  public:
    explicit CellRenderer(int threads) : workers_(threads) {}

    const Image& render(FramePlan& plan) override {
        if (!resize(plan))
            return image_;
        RasterFrame frame = frame_ = rasterFrame(plan);
        EdlSetup edl = edlSetup(plan.style.edl);
        placeNodes(plan);
        drawPoints(frame);
        colour(plan, frame, edl);
        plan.counters.passesRun += 2;
        if (edl.enabled)
            byRows([&](int y) { shadeRow(edl, distances_, y, image_); });
        ++(edl.enabled ? plan.counters.passesRun : plan.counters.passesSkipped);
        return image_;
    }

    std::vector<float> distances() const override {
        std::vector<float> result(image_.rgba.size() / 4);
        for (std::size_t i = 0; i < result.size(); ++i)
            if (cells_[i] != emptyCell)
                result[i] = distanceOfStep(frame_, static_cast<std::uint32_t>(cells_[i] >> indexBits));
        return result;
    }

  private:
    // False: there is nothing to draw into.
    bool resize(const FramePlan& plan) {
        bool drawable = plan.width > 0 && plan.height > 0 && plan.width <= maxPictureSide &&
                        plan.height <= maxPictureSide;
        image_.width = drawable ? plan.width : 0;
        image_.height = drawable ? plan.height : 0;
        std::size_t pixels = static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(image_.height);
        image_.rgba.resize(4 * pixels);
        cells_.resize(pixels + 1);
        cells_[pixels] = 0;
        return drawable;
    }

    template <class Row>
    void byRows(const Row& row) {
        auto pieces = static_cast<std::size_t>((image_.height + rowsPerPiece - 1) / rowsPerPiece);
        workers_.run(pieces, [&](std::size_t piece) {
            int first = static_cast<int>(piece) * rowsPerPiece;
            for (int y = first; y < std::min(first + rowsPerPiece, image_.height); ++y)
                row(y);
        });
    }

    void placeNodes(const FramePlan& plan) {
        octree_ = frame_.adaptive ? drawnOctree(plan) : DrawnOctree();
        nodes_.clear();
        std::uint64_t index = 0;
        for (std::size_t i : drawOrder(plan)) {
            nodes_.push_back({&plan.nodes[i], rasterNode(plan, plan.nodes[i]), index,
                              frame_.adaptive ? octree_.places[i] : 0});
            index += plan.nodes[i].pointCount;
        }
    }

    void drawPoints(const RasterFrame& frame) {
        byRows([&](int y) {
            auto width = static_cast<std::size_t>(image_.width);
            std::fill_n(cells_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * width),
                        width, emptyCell);
        });
        runs_.clear();
        for (const PlacedNode& placed : nodes_)
            for (std::uint32_t first = 0; first < placed.draw->pointCount; first += runPoints)
                runs_.push_back({placed.draw->node.get(), &placed.raster, first,
                                 std::min(runPoints, placed.draw->pointCount - first),
                                 placed.firstIndex + first, octree_.words.data(), placed.octreePlace});
        bool shared = workers_.threads() > 1;
        workers_.run(runs_.size(), [&](std::size_t i) { drawRun(frame, runs_[i], cells_.data(), shared); });
    }

    void colour(const FramePlan& plan, const RasterFrame& frame, const EdlSetup& edl) {
        if (edl.enabled)
            distances_.resize(frame.width, frame.height, edl);
        byRows([&](int y) {
            colourRow(plan, frame, nodes_, cells_.data(), y, image_, edl.enabled ? &distances_ : nullptr);
        });
    }

    WorkerPool workers_;
    Image image_;
    RasterFrame frame_; // of image_
    std::vector<std::uint64_t> cells_;
    DrawnOctree octree_; // adaptive sizes
    std::vector<PlacedNode> nodes_;
    std::vector<PointRun> runs_;
    InverseDistances distances_;
};

} // namespace

std::unique_ptr<SoftwareRenderer> SoftwareRenderer::create(int threads) {
    return std::make_unique<CellRenderer>(threads);
}

} // namespace stipple
