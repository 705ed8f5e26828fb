#include "converter/input/e57/measure.hpp"

#include "converter/parallel/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace stipple::e57 {

namespace {
void extendRange(std::optional<Range>& range, const Field& field, const Column& column,
                 const std::vector<std::uint32_t>& rows) {
    for (std::uint32_t row : rows) {
        double value = column.value(field, row);
        if (!std::isfinite(value))
            continue;
        if (!range)
            range = {value, value};
        range->min = std::min(range->min, value);
        range->max = std::max(range->max, value);
    }
}

Measure emptyMeasure(const Layout& layout) {
    Measure measure;
    for (std::size_t s = 0; s < layout.scans.size(); ++s) {
        measure.points.emplace_back(layout.sections[s].spans.size());
        measure.ranges.emplace_back(layout.scans[s].fields.size());
    }
    measure.local.resize(layout.scans.size());
    return measure;
}

// Of other spans: nothing depends on which thread read which.
void add(Measure& sum, const Measure& other) {
    sum.dropped.add(other.dropped);
    sum.bounds.extend(other.bounds);
    sum.world.extend(other.world);
    for (std::size_t s = 0; s < sum.points.size(); ++s) {
        sum.local[s].extend(other.local[s]);
        for (std::size_t i = 0; i < sum.points[s].size(); ++i)
            sum.points[s][i] += other.points[s][i];
        for (std::size_t f = 0; f < sum.ranges[s].size(); ++f) {
            std::optional<Range>& range = sum.ranges[s][f];
            const std::optional<Range>& more = other.ranges[s][f];
            if (more)
                range =
                    range ? Range{std::min(range->min, more->min), std::max(range->max, more->max)} : *more;
        }
    }
}

// What one thread measures with.
class Pass {
  public:
    Pass(std::unique_ptr<ByteSource> source, const Layout& layout,
         const std::vector<std::vector<std::size_t>>& ranged)
        : source_(std::move(source)), file_(*source_, layout.header, recordPagesPerBlock, recordBlocks),
          layout_(layout), ranged_(ranged), result_(emptyMeasure(layout)) {}

    Status measureSpan(std::size_t s, std::size_t index) {
        const ScanEntry& scan = layout_.scans[s];
        const RecordSpan& span = layout_.sections[s].spans[index];
        std::vector<std::size_t> used = layout_.coordinates[s].all();
        std::set<std::size_t> fields(used.begin(), used.end());
        fields.insert(ranged_[s].begin(), ranged_[s].end());
        std::vector<std::size_t> wanted(fields.begin(), fields.end());
        std::size_t run = RecordReader::goodRun(scan, wanted.size());
        RecordReader reader(file_, scan, layout_.sections[s], span, wanted);
        while (reader.remaining() > 0) {
            std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(run, reader.remaining()));
            STIPPLE_CHECK(reader.next(count, columns_));
            take(s, count);
            for (std::size_t field : ranged_[s])
                extendRange(result_.ranges[s][field], scan.fields[field], columns_[field], kept_.rows);
            result_.points[s][index] += kept_.rows.size();
        }
        return {};
    }
    const Measure& result() const { return result_; }

  private:
    void take(std::size_t s, std::size_t count) {
        const CoordinateFields& coordinates = layout_.coordinates[s];
        if (layout_.exact) {
            placeExactly(coordinates, layout_.exact->maps[s], columns_, count, kept_, result_.dropped);
            for (Vec3i p : kept_.positions)
                result_.bounds.extend(p);
            return;
        }
        locate(layout_.scans[s], coordinates, columns_, count, kept_, result_.dropped);
        for (Vec3d p : kept_.local)
            result_.local[s].extend(p);
        for (Vec3d p : kept_.world)
            result_.world.extend(p);
    }

    std::unique_ptr<ByteSource> source_;
    PagedFile file_;
    const Layout& layout_;
    const std::vector<std::vector<std::size_t>>& ranged_;
    Measure result_;
    std::vector<Column> columns_;
    Kept kept_;
};
} // namespace

Result<Measure> measure(const MeasureOptions& options, const Layout& layout,
                        const std::vector<std::vector<std::size_t>>& fields) {
    std::vector<std::pair<std::size_t, std::size_t>> spans; // scan and span
    for (std::size_t s = 0; s < layout.scans.size(); ++s)
        for (std::size_t i = 0; i < layout.sections[s].spans.size(); ++i)
            spans.emplace_back(s, i);
    std::vector<std::unique_ptr<Pass>> passes(static_cast<std::size_t>(std::max(1, options.threads)));
    STIPPLE_CHECK(
        parallelFor(spans.size(), options.threads, options.stop, [&](std::size_t i, int worker) -> Status {
            std::unique_ptr<Pass>& pass = passes[static_cast<std::size_t>(worker)];
            if (!pass) {
                STIPPLE_TRY(source, options.open());
                pass = std::make_unique<Pass>(std::move(source), layout, fields);
            }
            return pass->measureSpan(spans[i].first, spans[i].second);
        }));
    Measure result = emptyMeasure(layout);
    for (const std::unique_ptr<Pass>& pass : passes)
        if (pass)
            add(result, pass->result());
    return result;
}

} // namespace stipple::e57
