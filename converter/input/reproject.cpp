#include "converter/input/reproject.hpp"

#include "converter/input/float_grid.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace stipple {

namespace {
constexpr double metersPerDegree = 111320;       // on the equator; on a meridian within 0.7 % of it
constexpr double mostSteps = 9007199254740992.0; // 2^53: as far as a double counts
constexpr int latticePieces = 16;
constexpr double margin = 1.0 / 256;

double metersPerUnit(const Crs& crs, int axis) {
    auto index = static_cast<std::size_t>(axis);
    double meters = index < crs.axes.size() ? crs.axes[index].unitMeters : crs.unitMeters;
    // Heights without a system of their own are mostly in the unit of x and y; in geographic systems, in
    // metres.
    if (axis == 2 && meters == 0)
        return 1;
    return meters > 0 ? meters : metersPerDegree;
}

// The largest power of ten that is at most `step`, but for rounding.
double powerOfTenAtMost(double step) {
    int exponent = static_cast<int>(std::floor(std::log10(step) + 1e-9));
    return std::strtod(cat("1e", exponent).c_str(), nullptr);
}

// Coordinates of many points, axis by axis.
struct Coordinates {
    std::vector<double> axes[3];

    void resize(std::size_t count) {
        for (std::vector<double>& axis : axes)
            axis.resize(count);
    }
    void transform(CrsTransformer& by) {
        by.transform(axes[0].data(), axes[1].data(), axes[2].data(), axes[0].size());
    }
    bool isFinite(std::size_t i) const { return std::isfinite(axes[0][i]); }
};

BoxD worldBox(const Grid& grid, const BoxI& bounds) {
    BoxD box;
    if (!bounds.empty()) {
        box.extend(grid.toWorld(bounds.min));
        box.extend(grid.toWorld(bounds.max));
    }
    return box;
}

// Where the box comes to lie, by a lattice of places in it; without what can't be transformed.
BoxD transformedBox(const BoxD& box, CrsTransformer& transformer) {
    BoxD result;
    if (box.empty())
        return result;
    Coordinates places;
    for (int i = 0; i <= latticePieces; ++i)
        for (int j = 0; j <= latticePieces; ++j)
            for (double z : {box.min.z, box.max.z}) {
                auto at = [](double low, double high, int step) {
                    return low + (high - low) * step / latticePieces;
                };
                places.axes[0].push_back(at(box.min.x, box.max.x, i));
                places.axes[1].push_back(at(box.min.y, box.max.y, j));
                places.axes[2].push_back(z);
            }
    places.transform(transformer);
    for (std::size_t i = 0; i < places.axes[0].size(); ++i)
        if (places.isFinite(i))
            result.extend(Vec3d{places.axes[0][i], places.axes[1][i], places.axes[2][i]});
    if (!result.empty())
        for (int axis = 0; axis < 3; ++axis) {
            double more = (result.max[axis] - result.min[axis]) * margin;
            result.min[axis] -= more;
            result.max[axis] += more;
        }
    return result;
}

// Rounded outward.
BoxI onGrid(const BoxD& box, const Grid& grid) {
    BoxI result;
    if (box.empty())
        return result;
    Vec3d low = grid.toSteps(box.min), high = grid.toSteps(box.max);
    for (int axis = 0; axis < 3; ++axis) {
        result.min[axis] =
            static_cast<std::int64_t>(std::floor(std::clamp(low[axis], -mostSteps, mostSteps)));
        result.max[axis] =
            static_cast<std::int64_t>(std::ceil(std::clamp(high[axis], -mostSteps, mostSteps)));
    }
    return result;
}

class ReprojectedInput final : public PointInput {
  public:
    ReprojectedInput(std::unique_ptr<PointInput> input,
                     std::shared_ptr<const CrsTransformation> transformation)
        : input_(std::move(input)), transformation_(std::move(transformation)) {}

    Status describe(const Crs& to) {
        STIPPLE_TRY(transformer, transformation_->transformer());
        description_ = input_->description();
        InputDescription& d = description_;
        const InputDescription& from = input_->description();
        BoxD box = transformedBox(worldBox(from.grid, from.bounds), *transformer);
        chooseGrid(to, box);
        d.bounds = onGrid(box, d.grid);
        if (keepsHeights() && !d.bounds.empty()) {
            d.bounds.min.z = from.bounds.min.z;
            d.bounds.max.z = from.bounds.max.z;
        }
        d.boundsAreMeasured = false;
        d.source.format += cat(", reprojected from ", crsTitle(from.crs));
        d.crs = to;
        return {};
    }

    const InputDescription& description() const override { return description_; }
    const std::vector<InputPart>& parts() const override { return input_->parts(); }
    Result<std::unique_ptr<PointStream>> openPart(std::size_t part) const override;

    const Grid& sourceGrid() const { return input_->description().grid; }
    bool keepsHeights() const { return transformation_->facts().keepsHeights; }
    // New units in one old one: what a rounding of the input comes to.
    double unitRatio() const { return unitRatio_; }

  private:
    void chooseGrid(const Crs& to, const BoxD& box) {
        const InputDescription& from = input_->description();
        double step[3];
        for (int axis = 0; axis < 3; ++axis)
            step[axis] = from.grid.scale[axis] * metersPerUnit(from.crs, axis) / metersPerUnit(to, axis);
        unitRatio_ = metersPerUnit(from.crs, 0) / metersPerUnit(to, 0);
        Grid plane = floatGrid(box, {}, powerOfTenAtMost(std::min(step[0], step[1])));
        Grid heights = floatGrid(box, {}, powerOfTenAtMost(step[2]));
        if (box.empty()) { // nothing is known of where the points lie
            plane.scale.x = plane.scale.y = powerOfTenAtMost(std::min(step[0], step[1]));
            heights.scale.z = powerOfTenAtMost(step[2]);
        }
        const Grid& z = keepsHeights() ? from.grid : heights;
        description_.grid = {{plane.scale.x, plane.scale.y, z.scale.z},
                             {plane.offset.x, plane.offset.y, z.offset.z}};
    }

    std::unique_ptr<PointInput> input_;
    std::shared_ptr<const CrsTransformation> transformation_;
    InputDescription description_;
    double unitRatio_ = 1;
};

class ReprojectedStream final : public PointStream {
  public:
    ReprojectedStream(const ReprojectedInput& input, std::unique_ptr<PointStream> source,
                      std::unique_ptr<CrsTransformer> transformer)
        : input_(input), source_(std::move(source)), transformer_(std::move(transformer)) {}

    Status next(PointBatch& batch) override {
        // A batch of which nothing is left is not the end.
        do {
            STIPPLE_CHECK(source_->next(batch));
            if (batch.size() == 0)
                break;
            transform(batch);
        } while (batch.size() == 0);
        report_ = own_;
        ReadReport read = source_->report();
        read.maxRounding *= input_.unitRatio();
        report_.add(read);
        return {};
    }
    const ReadReport& report() const override { return report_; }

  private:
    void transform(PointBatch& batch) {
        std::size_t count = batch.size(), kept = 0;
        const Grid& from = input_.sourceGrid();
        places_.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            Vec3d world = from.toWorld(batch.positions[i]);
            for (int axis = 0; axis < 3; ++axis)
                places_.axes[axis][i] = world[axis];
        }
        places_.transform(*transformer_);
        for (std::size_t i = 0; i < count; ++i)
            if (place(i, batch.positions[i])) {
                if (kept < i)
                    move(batch, i, kept);
                ++kept;
            }
        batch.resize(input_.description().schema, kept);
    }

    // The integers of a transformed point; false if it has none.
    bool place(std::size_t i, Vec3i& position) {
        if (!places_.isFinite(i)) {
            ++own_.untransformable;
            return false;
        }
        const Grid& grid = input_.description().grid;
        Vec3d world{places_.axes[0][i], places_.axes[1][i], places_.axes[2][i]};
        Vec3d steps = grid.toSteps(world);
        int changed = input_.keepsHeights() ? 2 : 3;
        for (int axis = 0; axis < changed; ++axis)
            if (!(std::abs(steps[axis]) < mostSteps)) {
                ++own_.outOfRange;
                return false;
            }
        for (int axis = 0; axis < changed; ++axis)
            position[axis] = std::llround(steps[axis]);
        Vec3d placed = grid.toWorld(position);
        for (int axis = 0; axis < changed; ++axis)
            own_.maxRounding = std::max(own_.maxRounding, std::abs(placed[axis] - world[axis]));
        return true;
    }

    void move(PointBatch& batch, std::size_t from, std::size_t to) {
        const Schema& schema = input_.description().schema;
        batch.positions[to] = batch.positions[from];
        for (std::size_t a = 0; a < batch.columns.size(); ++a) {
            std::size_t width = schema.attributes[a].size();
            std::copy_n(batch.columns[a].data() + from * width, width, batch.columns[a].data() + to * width);
        }
    }

    const ReprojectedInput& input_;
    std::unique_ptr<PointStream> source_;
    std::unique_ptr<CrsTransformer> transformer_;
    Coordinates places_;
    ReadReport own_, report_;
};

Result<std::unique_ptr<PointStream>> ReprojectedInput::openPart(std::size_t part) const {
    STIPPLE_TRY(source, input_->openPart(part));
    STIPPLE_TRY(transformer, transformation_->transformer());
    return std::unique_ptr<PointStream>(
        std::make_unique<ReprojectedStream>(*this, std::move(source), std::move(transformer)));
}
} // namespace

Result<std::unique_ptr<PointInput>> reprojectInput(std::unique_ptr<PointInput> input,
                                                   std::shared_ptr<const CrsTransformation> transformation,
                                                   const Crs& to) {
    auto reprojected = std::make_unique<ReprojectedInput>(std::move(input), std::move(transformation));
    STIPPLE_CHECK(reprojected->describe(to));
    return std::unique_ptr<PointInput>(std::move(reprojected));
}

} // namespace stipple
