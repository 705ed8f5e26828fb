#include "converter/input/float_grid.hpp"
#include "converter/input/table_coordinates.hpp"
#include "converter/input/table_plan.hpp"
#include "converter/input/table_values.hpp"
#include "converter/parallel/parallel.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <atomic>
#include <filesystem>

namespace stipple {

namespace {
constexpr int float32Bits = 24;
constexpr std::size_t blockBytes = std::size_t{1} << 20, batchBytes = std::size_t{1} << 24;

// Rows of a part of the file; `points` of them are points.
struct TablePart {
    RowPlace place;
    std::uint64_t rows = 0, points = 0;
};

// What was found between two places at which rows can be entered.
struct Stretch {
    Measure measure;
    std::vector<TablePart> parts;
    RowPlace end; // behind its last row
};

class TableInput final : public PointInput {
  public:
    TableInput(const std::string& path, std::unique_ptr<TableFormat> format) : format_(std::move(format)) {
        description_.path = path;
    }

    Status prepare(const InputOptions& options) {
        Measure measure;
        STIPPLE_CHECK(measureAll(measure, options));
        measure.fields.resize(table().fields.size());
        format_->finish(measure.fields);
        plan_ = planTable(table(), measure.fields);
        describe(measure, options);
        format_->source().rest();
        return {};
    }

    const InputDescription& description() const override { return description_; }
    const std::vector<InputPart>& parts() const override { return inputParts_; }
    Result<std::unique_ptr<PointStream>> openPart(std::size_t part) const override;

    // The file rests while no stream reads it.
    void enter() const { ++streams_; }
    void leave() const {
        if (--streams_ == 0)
            format_->source().rest();
    }

    const Table& table() const { return format_->table(); }
    const TablePlan& plan() const { return plan_; }
    const CoordinateScale& scale() const { return scale_; }

    // Fewer where rows are long.
    std::size_t rowsOfBlock() const {
        std::size_t rowBytes = 1;
        for (const TableField& field : table().fields)
            rowBytes += field.bytesPerRow();
        return std::clamp<std::size_t>(blockBytes / rowBytes, 1, rowsPerBlock);
    }
    std::size_t rowsOfBatch() const {
        std::size_t pointBytes = sizeof(Vec3i) + plan_.schema.bytesPerPoint();
        return std::clamp<std::size_t>(batchBytes / pointBytes, rowsOfBlock(), pointsPerBatch);
    }

  private:
    // Reads every row once, and divides them. What the parts are does not depend on the threads.
    Status measureAll(Measure& measure, const InputOptions& options) {
        const RowStretches found = format_->stretches();
        std::vector<Stretch> stretches(found.places.size());
        Status done = parallelFor(stretches.size(), options.threads, options.stop, [&](std::size_t i, int) {
            return measureStretch(found.places[i], stretches[i]);
        });
        if (stretches.size() > 1 && !(done.ok() && areWhole(stretches)) && !isOutside(done)) {
            // One after the other they are read as the format means them, and errors know their lines.
            stretches.assign(1, {});
            done = measureStretch(format_->begin(), stretches[0]);
        }
        STIPPLE_CHECK(done);
        join(stretches, found.areCounted, measure);
        return {};
    }

    Status measureStretch(const RowPlace& place, Stretch& stretch) const {
        STIPPLE_TRY(reader, format_->rowsFrom(place));
        Rows rows;
        ReadReport unused;
        TablePart part{reader->place()};
        for (;;) {
            STIPPLE_CHECK(reader->next(rows, static_cast<std::size_t>(std::min<std::uint64_t>(
                                                 rowsOfBlock(), rowsPerPart - part.rows))));
            const bool ends = rows.count == 0;
            part.rows += rows.count;
            const std::uint64_t before = stretch.measure.points;
            keepPoints(table(), rows, unused);
            measureRows(table(), rows, stretch.measure);
            part.points += stretch.measure.points - before;
            if ((ends && part.rows > 0) || part.rows == rowsPerPart) {
                stretch.parts.push_back(part);
                part = TablePart{reader->place()};
            }
            stretch.end = reader->place();
            if (ends)
                return {};
        }
    }

    static std::uint64_t rowsOf(const Stretch& stretch) {
        std::uint64_t rows = 0;
        for (const TablePart& part : stretch.parts)
            rows += part.rows;
        return rows;
    }
    bool areWhole(const std::vector<Stretch>& stretches) const {
        std::uint64_t rows = 0;
        for (const Stretch& stretch : stretches)
            rows += rowsOf(stretch);
        return format_->areWhole(stretches[0].end, rows);
    }
    // An error that reading once more would not explain.
    static bool isOutside(const Status& done) {
        return !done.ok() &&
               (done.error().code == ErrorCode::cancelled || done.error().code == ErrorCode::ioFailed ||
                done.error().code == ErrorCode::changed || done.error().code == ErrorCode::outOfMemory);
    }

    void join(const std::vector<Stretch>& stretches, bool areCounted, Measure& measure) {
        std::uint64_t rowsBefore = 0, linesBefore = 0;
        for (std::size_t s = 0; s < stretches.size(); ++s) {
            const Stretch& stretch = stretches[s];
            const bool isRelative = s > 0 && !areCounted;
            for (TablePart part : stretch.parts) {
                part.place.row += isRelative ? rowsBefore : 0;
                part.place.line += isRelative ? linesBefore : 0;
                parts_.push_back(part);
                inputParts_.push_back({part.points});
            }
            measure.add(stretch.measure);
            rowsBefore += rowsOf(stretch);
            linesBefore += stretch.end.line - 1;
        }
    }

    void describe(const Measure& measure, const InputOptions& options) {
        InputDescription& d = description_;
        d.source = {std::filesystem::path(d.path).filename().string(), table().format, measure.points,
                    format_->source().sizeBytes()};
        d.schema = plan_.schema;
        d.warnings = table().warnings;
        d.warnings.insert(d.warnings.end(), plan_.warnings.begin(), plan_.warnings.end());
        d.boundsAreMeasured = true;
        const TableField& x = table().fields[table().position[0]];
        BoxD bounds = measure.bounds;
        Precision precision;
        if (x.isText && measure.points > 0) {
            if (x.type == AttributeType::f32)
                precision.significandBits = float32Bits;
            precision.decimals = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const DecimalRange& range = measure.decimalAxes[static_cast<std::size_t>(axis)];
                bounds.min[axis] = decimalToDouble(range.min, range.decimals);
                bounds.max[axis] = decimalToDouble(range.max, range.decimals);
                precision.decimals = std::max(precision.decimals, range.decimals);
            }
        } else if (std::optional<int> decimals = format_->decimals()) {
            precision.decimals = *decimals;
        } else if (!x.isText) {
            precision = binaryPrecision();
        }
        d.grid = floatGrid(bounds, precision, options.scale);
        scale_ = CoordinateScale(d.grid);
        if (measure.points > 0)
            d.bounds = gridBounds(measure, bounds);
    }

    // Coordinates of integer types are decimals without digits after the point.
    Precision binaryPrecision() const {
        Precision precision;
        bool whole = true, narrow = true;
        for (std::size_t field : table().position) {
            whole = whole && isInteger(*table().fields[field].type);
            narrow = narrow && *table().fields[field].type != AttributeType::f64;
        }
        if (whole)
            precision.decimals = 0;
        else if (narrow)
            precision.significandBits = float32Bits;
        return precision;
    }

    BoxI gridBounds(const Measure& measure, const BoxD& bounds) const {
        BoxI box;
        double unused = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const DecimalRange& range = measure.decimalAxes[static_cast<std::size_t>(axis)];
            if (range.any) {
                box.min[axis] = scale_.toGrid(axis, range.min, range.decimals);
                box.max[axis] = scale_.toGrid(axis, range.max, range.decimals);
            } else {
                box.min[axis] = scale_.toGrid(axis, bounds.min[axis], unused);
                box.max[axis] = scale_.toGrid(axis, bounds.max[axis], unused);
            }
        }
        return box;
    }

    std::unique_ptr<TableFormat> format_;
    InputDescription description_;
    TablePlan plan_;
    CoordinateScale scale_;
    std::vector<TablePart> parts_;
    std::vector<InputPart> inputParts_;
    mutable std::atomic<int> streams_{0};
};

class TableStream final : public PointStream {
  public:
    TableStream(const TableInput& input, std::unique_ptr<RowReader> reader, std::uint64_t rows)
        : input_(input), reader_(std::move(reader)), left_(rows) {
        input_.enter();
    }
    ~TableStream() override { input_.leave(); }

    Status next(PointBatch& batch) override {
        const Schema& schema = input_.plan().schema;
        const std::size_t most = input_.rowsOfBatch(), step = input_.rowsOfBlock();
        batch.resize(schema, static_cast<std::size_t>(std::min<std::uint64_t>(most, left_)));
        std::size_t filled = 0;
        // Rows may all be left out: on until some are points, as an empty batch is the end.
        while (left_ > 0 && (filled == 0 || filled + step <= most)) {
            STIPPLE_CHECK(
                reader_->next(rows_, static_cast<std::size_t>(std::min<std::uint64_t>(step, left_))));
            if (rows_.count == 0)
                return Error{ErrorCode::changed, "the file ends earlier than when it was opened",
                             input_.description().path, "convert again when it is complete"};
            left_ -= rows_.count;
            keepPoints(input_.table(), rows_, report_);
            convertPositions(input_.table(), input_.scale(), rows_, batch.positions.data() + filled,
                             report_.maxRounding);
            convertColumns(input_.table(), input_.plan(), rows_, batch, filled);
            filled += rows_.count;
        }
        batch.resize(schema, filled);
        return {};
    }
    const ReadReport& report() const override { return report_; }

  private:
    const TableInput& input_;
    std::unique_ptr<RowReader> reader_;
    std::uint64_t left_; // rows
    Rows rows_;
    ReadReport report_;
};

Result<std::unique_ptr<PointStream>> TableInput::openPart(std::size_t part) const {
    STIPPLE_TRY(reader, format_->rowsFrom(parts_[part].place));
    return std::unique_ptr<PointStream>(
        std::make_unique<TableStream>(*this, std::move(reader), parts_[part].rows));
}
} // namespace

Result<std::unique_ptr<PointInput>> openTable(const std::string& path, std::unique_ptr<TableFormat> format,
                                              const InputOptions& options) {
    auto input = std::make_unique<TableInput>(path, std::move(format));
    STIPPLE_CHECK(input->prepare(options));
    return std::unique_ptr<PointInput>(std::move(input));
}

} // namespace stipple
