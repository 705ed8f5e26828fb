#include "converter/input/e57/measure.hpp"

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

class Pass {
  public:
    Pass(PagedFile& file, const Layout& layout, Measure& result)
        : file_(file), layout_(layout), result_(result) {}

    Status measureScan(std::size_t s, const std::vector<std::size_t>& ranged) {
        const ScanEntry& scan = layout_.scans[s];
        std::vector<std::size_t> used = layout_.coordinates[s].all();
        std::set<std::size_t> fields(used.begin(), used.end());
        fields.insert(ranged.begin(), ranged.end());
        std::vector<std::size_t> wanted(fields.begin(), fields.end());
        std::size_t run = RecordReader::goodRun(scan, wanted.size());
        for (const RecordSpan& span : layout_.sections[s].spans) {
            RecordReader reader(file_, scan, layout_.sections[s], span, wanted);
            std::uint64_t points = 0;
            while (reader.remaining() > 0) {
                std::size_t count =
                    static_cast<std::size_t>(std::min<std::uint64_t>(run, reader.remaining()));
                STIPPLE_CHECK(reader.next(count, columns_));
                take(s, count);
                for (std::size_t field : ranged)
                    extendRange(result_.ranges[s][field], scan.fields[field], columns_[field], kept_.rows);
                points += kept_.rows.size();
            }
            result_.points[s].push_back(points);
        }
        return {};
    }

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

    PagedFile& file_;
    const Layout& layout_;
    Measure& result_;
    std::vector<Column> columns_;
    Kept kept_;
};
} // namespace

Result<Measure> measure(ByteSource& source, const Layout& layout,
                        const std::vector<std::vector<std::size_t>>& fields) {
    Measure result;
    PagedFile file(source, layout.header, recordPagesPerBlock, recordBlocks);
    result.points.resize(layout.scans.size());
    result.local.resize(layout.scans.size());
    for (const ScanEntry& scan : layout.scans)
        result.ranges.emplace_back(scan.fields.size());
    Pass pass(file, layout, result);
    for (std::size_t s = 0; s < layout.scans.size(); ++s)
        STIPPLE_CHECK(pass.measureScan(s, fields[s]));
    return result;
}

} // namespace stipple::e57
