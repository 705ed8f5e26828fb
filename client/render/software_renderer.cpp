#include "client/render/software_renderer.hpp"

#include "client/render/drawn_octree.hpp"
#include "client/render/picture_parts.hpp"
#include "client/render/raster_setup.hpp"
#include "client/render/software_cells.hpp"
#include "client/render/software_expansion.hpp"
#include "client/render/software_points.hpp"
#include "client/render/software_shading.hpp"
#include "client/render/software_splats.hpp"
#include "client/render/worker_pool.hpp"

#include <algorithm>
#include <atomic>

namespace stipple {
namespace {

constexpr std::uint32_t runPoints = 16384; // a run is one piece of work: about 100 µs
constexpr int rowsPerPiece = 16;
// Each needs 32 bytes a pixel.
constexpr int maxBlendingThreads = 8;
constexpr ExpansionCosts expansionCosts{1, 0.5};

class CellRenderer final : public SoftwareRenderer {
  public:
    explicit CellRenderer(int threads) : workers_(threads) {}

    const Image& render(FramePlan& plan) override {
        if (!resize(plan))
            return image_;
        RasterFrame frame = frame_ = rasterFrame(plan);
        EdlSetup edl = edlSetup(plan.style.edl);
        std::vector<std::size_t> order = partOrder(plan, frame);
        countOutside(plan, order);
        placeNodes(plan, order);
        bool late = expandsLate(plan, frame, expansionCosts);
        makeRuns();
        if (late)
            drawExpanded(frame);
        else
            drawWhole(frame, cells_);
        if (frame.splats) {
            gather(cells_);
            blend(frame, late);
        }
        if (late)
            byRows([&](int y) {
                cells_.gatherRow(y);
                nameExpandedRow(frame, centres(), y, cells_.cells());
            });
        colour(plan, frame, edl, frame.splats || late);
        plan.counters.passesRun += 2 + (frame.splats ? 1 : 0) + (late ? 1 : 0);
        if (edl.enabled)
            byRows([&](int y) { shadeRow(edl, distances_, y, image_); });
        ++(edl.enabled ? plan.counters.passesRun : plan.counters.passesSkipped);
        return image_;
    }

    std::vector<float> distances() const override {
        std::vector<float> result(image_.rgba.size() / 4);
        for (std::size_t i = 0; i < result.size(); ++i)
            if (std::uint64_t cell = cells_.cells()[i]; cell != emptyCell)
                result[i] = distanceOfStep(frame_, static_cast<std::uint32_t>(cell >> indexBits));
        return result;
    }

    std::optional<PickHit> pick(const FramePlan& plan, const PickRequest& request) override {
        PickTarget target = pickTarget(plan, request);
        if (!resize(plan) || target.window.empty())
            return std::nullopt;
        frame_ = target.frame;
        placeNodes(plan, target.order);
        makeRuns();
        // Elsewhere the cells keep what they held, and nobody looks at them.
        RowRange rows = rowsOf(target.window);
        clearRows(cells_, rows.first, rows.end);
        if (expandsLate(plan, target.frame, expansionCosts))
            drawExpandedAt(target);
        else
            drawFew(target.frame, cells_);
        std::vector<PickSample> samples = samplesIn(target.window);
        clearRows(cells_, 0, image_.height); // the last picture is gone
        return nearestHit(target, samples);
    }

  private:
    RowRange rowsOf(const PictureWindow& window) const {
        int end = image_.height - window.bottom;
        return {end - window.height, end};
    }

    // What drawExpanded() draws, in the rows of the window.
    void drawExpandedAt(const PickTarget& target) {
        RowRange centreRows = rowsOf(target.centres), rows = rowsOf(target.window);
        centres_.resize(image_.width, image_.height, workers_.threads());
        clearRows(centres_, centreRows.first, centreRows.end);
        drawFew(singlePixelFrame(target.frame), centres_);
        expandRows(target.frame, centres(), centreRows, cells_.cells(), false);
        for (int y = rows.first; y < rows.end; ++y)
            nameExpandedRow(target.frame, centres(), y, cells_.cells());
    }

    // All threads draw into the first part, and the others need not be looked through.
    void drawFew(const RasterFrame& frame, CellParts& cells) {
        workers_.run(runs_.size(),
                     [&](std::size_t i) { drawRun(frame, runs_[i], cells.cells(), workers_.threads() > 1); });
    }

    std::vector<PickSample> samplesIn(const PictureWindow& window) const {
        std::vector<PickSample> samples;
        for (int row = window.bottom; row < window.bottom + window.height; ++row) {
            std::size_t line =
                static_cast<std::size_t>(image_.height - 1 - row) * static_cast<std::size_t>(image_.width);
            for (int column = window.left; column < window.left + window.width; ++column)
                if (std::uint64_t cell = cells_.cells()[line + static_cast<std::size_t>(column)];
                    cell != emptyCell)
                    samples.push_back(sampleOf(cell, column, row));
        }
        return samples;
    }

    PickSample sampleOf(std::uint64_t cell, int column, int row) const {
        std::uint64_t index = cell & indexMask;
        auto after =
            std::upper_bound(nodes_.begin(), nodes_.end(), index,
                             [](std::uint64_t at, const PlacedNode& node) { return at < node.firstIndex; });
        std::size_t node = static_cast<std::size_t>(after - nodes_.begin()) - 1;
        return {column, row, static_cast<std::uint32_t>(cell >> indexBits), node,
                static_cast<std::uint32_t>(index - nodes_[node].firstIndex)};
    }

    // False: there is nothing to draw into.
    bool resize(const FramePlan& plan) {
        bool drawable = isDrawable(plan, maxPartSide);
        PictureWindow drawn = drawnWindow(plan);
        image_.width = drawable ? drawn.width : 0;
        image_.height = drawable ? drawn.height : 0;
        cells_.resize(image_.width, image_.height, workers_.threads());
        image_.rgba.resize(4 * cells_.pixels());
        return drawable;
    }

    std::size_t rowPieces() const {
        return static_cast<std::size_t>((image_.height + rowsPerPiece - 1) / rowsPerPiece);
    }
    RowRange rowsOf(std::size_t piece) const {
        int first = static_cast<int>(piece) * rowsPerPiece;
        return {first, std::min(first + rowsPerPiece, image_.height)};
    }

    template <class Row>
    void byRows(const Row& row) {
        workers_.run(rowPieces(), [&](std::size_t piece) {
            RowRange rows = rowsOf(piece);
            for (int y = rows.first; y < rows.end; ++y)
                row(y);
        });
    }

    void placeNodes(const FramePlan& plan, const std::vector<std::size_t>& order) {
        if (!frame_.splats)
            sums_.clear();
        octree_ = walksOctree(frame_) ? drawnOctree(plan) : DrawnOctree();
        nodes_.clear();
        std::uint64_t index = 0;
        for (std::size_t i : order) {
            nodes_.push_back({&plan.nodes[i], rasterNode(plan, plan.nodes[i]), index,
                              walksOctree(frame_) ? octree_.places[i] : 0});
            index += plan.nodes[i].pointCount;
        }
    }

    static const std::uint32_t* hidingWords(const DrawNode& node) {
        return node.paint && node.paint->hidden > 0 ? node.paint->words->data() : nullptr;
    }

    const std::uint32_t* normalWords(const DrawNode& node) const {
        return frame_.disc && node.normals ? node.normals->words.data() : nullptr;
    }

    void clearRows(CellParts& cells, int first, int end) {
        byRows([&](int y) {
            if (y >= first && y < end)
                cells.clearRow(y);
        });
    }

    void makeRuns() {
        runs_.clear();
        runNodes_.clear();
        for (const PlacedNode& placed : nodes_)
            for (std::uint32_t first = 0; first < placed.draw->pointCount; first += runPoints) {
                runNodes_.push_back(&placed);
                runs_.push_back({placed.draw->node.get(), &placed.raster, first,
                                 std::min(runPoints, placed.draw->pointCount - first),
                                 placed.firstIndex + first, octree_.words.data(), placed.octreePlace,
                                 hidingWords(*placed.draw), normalWords(*placed.draw)});
            }
    }

    void drawWhole(const RasterFrame& frame, CellParts& cells) {
        clearRows(cells, 0, image_.height);
        drawPoints(frame, cells);
    }

    void drawPoints(const RasterFrame& frame, CellParts& cells) {
        drawPieces(cells, runs_.size(), [&](std::size_t i, std::uint64_t* part, bool shared) {
            drawRun(frame, runs_[i], part, shared);
        });
    }

    // draw(piece, part, shared) for all pieces: into the first part, if `shared` by several threads.
    template <class Draw>
    void drawPieces(CellParts& cells, std::size_t pieces, const Draw& draw) {
        auto threads = static_cast<std::size_t>(workers_.threads());
        std::atomic<std::size_t> next{0};
        workers_.run(threads, [&](std::size_t thread) {
            for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < pieces;)
                draw(i, cells.part(thread % cells.count()), threads > cells.count());
        });
    }

    // Before anybody looks at the cells; where each row is looked at alone, it is gathered then.
    void gather(CellParts& cells) {
        if (cells.count() > 1)
            byRows([&](int y) { cells.gatherRow(y); });
    }

    Centres centres() const { return {&nodes_, octree_.words.data(), centres_.cells()}; }

    void drawExpanded(const RasterFrame& frame) {
        centres_.resize(image_.width, image_.height, workers_.threads());
        drawWhole(singlePixelFrame(frame), centres_);
        gather(centres_);
        clearRows(cells_, 0, image_.height);
        drawPieces(cells_, rowPieces(), [&](std::size_t piece, std::uint64_t* part, bool shared) {
            expandRows(frame, centres(), rowsOf(piece), part, shared);
        });
    }

    // Each thread adds to sums of its own.
    void blend(const RasterFrame& frame, bool late) {
        std::size_t pixels = image_.rgba.size() / 4;
        sums_.resize(static_cast<std::size_t>(std::min(workers_.threads(), maxBlendingThreads)));
        std::atomic<std::size_t> next{0};
        std::size_t pieces = late ? rowPieces() : runs_.size();
        workers_.run(sums_.size(), [&](std::size_t thread) {
            std::vector<PixelSums>& sums = sums_[thread];
            sums.assign(pixels, {});
            for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < pieces;)
                if (late)
                    blendExpandedRows(frame, centres(), rowsOf(i), cells_.cells(), sums.data());
                else
                    blendRun(frame, *runNodes_[i], runs_[i], cells_.cells(), sums.data());
        });
    }

    void colour(const FramePlan& plan, const RasterFrame& frame, const EdlSetup& edl, bool gathered) {
        if (edl.enabled)
            distances_.resize(frame.width, frame.height, edl);
        std::vector<const PixelSums*> sums;
        for (const std::vector<PixelSums>& part : sums_)
            sums.push_back(part.data());
        byRows([&](int y) {
            if (!gathered)
                cells_.gatherRow(y);
            if (frame.splats)
                return blendedRow(plan, frame, sums, cells_.cells(), y, image_,
                                  edl.enabled ? &distances_ : nullptr);
            colourRow(plan, frame, nodes_, cells_.cells(), y, image_, edl.enabled ? &distances_ : nullptr);
        });
    }

    WorkerPool workers_;
    Image image_;
    RasterFrame frame_; // of image_
    CellParts cells_;
    CellParts centres_;  // points as single pixels: delayed expansion
    DrawnOctree octree_; // adaptive sizes
    std::vector<PlacedNode> nodes_;
    std::vector<PointRun> runs_;
    std::vector<const PlacedNode*> runNodes_;  // parallel to runs_
    std::vector<std::vector<PixelSums>> sums_; // per thread: splats
    InverseDistances distances_;
};

} // namespace

std::unique_ptr<SoftwareRenderer> SoftwareRenderer::create(int threads) {
    return std::make_unique<CellRenderer>(threads);
}

} // namespace stipple
