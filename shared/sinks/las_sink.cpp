#include "shared/sinks/las_sink.hpp"

#include "shared/base/text.hpp"
#include "shared/las/record_layout.hpp"
#include "shared/points/gps_time.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

namespace stipple {

namespace {

constexpr std::int64_t lowest = std::numeric_limits<std::int32_t>::min();
constexpr std::int64_t highest = std::numeric_limits<std::int32_t>::max();
// Shifts are multiples of this many steps, so that offsets stay round decimal numbers.
constexpr std::int64_t shiftUnit = 1'000'000;

// What to subtract from the integers so that they fit 32 bits; 0 on axes where they do.
Result<Vec3i> shiftInto32Bits(const BoxI& reach) {
    Vec3i shift;
    for (int axis = 0; axis < 3 && !reach.empty(); ++axis) {
        std::int64_t low = reach.min[axis], high = reach.max[axis];
        if (low >= lowest && high <= highest)
            continue;
        shift[axis] = (low / 2 + high / 2) / shiftUnit * shiftUnit;
        if (low - shift[axis] < lowest || high - shift[axis] > highest)
            return Error{
                ErrorCode::outOfRange,
                cat("the points span more grid steps in ", "xyz"[axis], " than a LAS file can count (2^32)"),
                "", "export a part of them with --box, or PLY or CSV"};
    }
    return shift;
}

// The point format in the text of a source: "LAS 1.2, point format 2"; -1 if there is none.
int statedPointFormat(const std::string& format) {
    constexpr std::string_view before = "point format ";
    std::size_t at = format.find(before);
    int number = -1;
    if (at != std::string::npos)
        std::from_chars(format.data() + at + before.size(), format.data() + format.size(), number);
    return number <= 10 ? number : -1;
}

int commonPointFormat(const std::vector<SourceFile>& sources) {
    int common = sources.empty() ? -1 : statedPointFormat(sources[0].format);
    for (const SourceFile& source : sources)
        if (statedPointFormat(source.format) != common)
            return -1;
    return common;
}

// The attribute as LAS defines it, whichever format has it.
const Attribute* lasAttribute(const std::string& name) {
    static const std::array<Schema, 2> all{las::schemaOf(5), las::schemaOf(10)};
    for (const Schema& schema : all)
        if (int index = schema.find(name); index >= 0)
            return &schema.attributes[static_cast<std::size_t>(index)];
    return nullptr;
}

// Does every value of the attribute fit the bits it has in that format?
bool fitsField(const SinkInput& input, std::size_t i, const las::RecordField& field) {
    auto a = static_cast<std::size_t>(input.attributes[i]);
    if (field.bits == 0 || a >= input.metadata.statistics.size())
        return true;
    return input.metadata.statistics[a].max < static_cast<double>(1 << field.bits);
}

// How many attributes the format has fields for; -1 if a field is too narrow for its values.
int heldBy(int format, const SinkInput& input, const Schema& schema) {
    las::RecordLayout layout = las::baseLayout(format);
    int held = 0;
    for (std::size_t i = 0; i < schema.attributes.size(); ++i)
        if (auto field = las::findField(layout, schema.attributes[i].name)) {
            if (!fitsField(input, i, *field))
                return -1;
            ++held;
        }
    return held;
}

int choosePointFormat(const SinkInput& input, const Schema& schema) {
    int common = commonPointFormat(input.metadata.sources);
    bool keepsAll = schema.attributes.size() == input.metadata.schema.attributes.size();
    if (common >= 0 && keepsAll && heldBy(common, input, schema) >= 0)
        return common;
    int best = 6, mostHeld = -1;
    for (int format = 0; format <= 10; ++format)
        if (int held = heldBy(format, input, schema); held > mostHeld) {
            best = format;
            mostHeld = held;
        }
    return best;
}

// LAS has one type for each of its names; others need another name.
Schema namedForLas(Schema schema, std::vector<std::string>& warnings) {
    for (std::size_t a = 0; a < schema.attributes.size(); ++a) {
        const Attribute* field = lasAttribute(schema.attributes[a].name);
        Attribute& attribute = schema.attributes[a];
        if (!field || (field->type == attribute.type && attribute.components == 1))
            continue;
        std::string name = cat(attribute.name, " (", attributeTypeName(attribute.type), ")");
        for (int i = 2; schema.find(name) >= 0; ++i)
            name = cat(attribute.name, " (", i, ")");
        warnings.push_back(cat("LAS stores \"", attribute.name, "\" as one ", attributeTypeName(field->type),
                               "; it went to the extra bytes as \"", name, "\""));
        attribute.name = name;
    }
    return schema;
}

std::string wktOf(const Crs& crs, const WktOfCode& wktOfCode, std::vector<std::string>& warnings) {
    if (!crs.wkt.empty() || !crs.epsg)
        return crs.wkt;
    Result<std::string> wkt =
        wktOfCode ? wktOfCode(*crs.epsg)
                  : Error{ErrorCode::unsupported, "no list of systems is at hand", "", "export it natively"};
    if (wkt.ok())
        return *wkt;
    warnings.push_back(cat("the cloud's CRS is EPSG:", *crs.epsg,
                           ", which could not be written as WKT: ", wkt.error().sentence()));
    return "";
}

bool hasStandardGpsTime(const Schema& schema) {
    int time = schema.find(attribute_names::gpsTime);
    return time >= 0 && schema.attributes[static_cast<std::size_t>(time)].description == standardGpsTimeText;
}

} // namespace

Result<LasPlan> LasPlan::make(const SinkInput& input, const BoxI& reach, std::uint64_t expectedPoints,
                              bool compressed, const WktOfCode& wktOfCode) {
    LasPlan plan;
    STIPPLE_TRY(shift, shiftInto32Bits(reach));
    plan.shift = shift;
    las::WriterOptions& options = plan.options;
    options.grid = input.metadata.grid;
    for (int axis = 0; axis < 3; ++axis)
        if (shift[axis] != 0)
            options.grid.offset[axis] = input.metadata.grid.toWorld(shift)[axis];
    options.schema = namedForLas(input.schema(), plan.warnings);
    options.pointFormat = choosePointFormat(input, options.schema);
    options.expectedPoints = expectedPoints;
    options.compressed = compressed;
    options.wkt = wktOf(input.metadata.crs, wktOfCode, plan.warnings);
    options.globalEncoding = hasStandardGpsTime(options.schema) ? 1 : 0;
    return plan;
}

Result<std::unique_ptr<LasSink>> LasSink::create(std::unique_ptr<ByteSink> to, const LasPlan& plan,
                                                 std::optional<las::PointSummary> summary) {
    std::unique_ptr<LasSink> sink(new LasSink());
    sink->shift_ = plan.shift;
    sink->warnings_ = plan.warnings;
    STIPPLE_TRY(writer, las::Writer::create(std::move(to), plan.options, std::move(summary)));
    sink->writer_ = std::move(writer);
    for (const std::string& warning : sink->writer_->warnings())
        sink->warnings_.push_back(warning);
    return sink;
}

Result<EncodedPoints> LasSink::encode(PointBatch batch) const {
    if (shift_ != Vec3i{})
        for (Vec3i& position : batch.positions)
            position = position - shift_;
    EncodedPoints points;
    points.count = batch.size();
    points.batch = std::move(batch);
    return points;
}

Status LasSink::write(EncodedPoints points) {
    return writer_->write(points.batch);
}

Status LasSink::finish() {
    return writer_->finish();
}

} // namespace stipple
