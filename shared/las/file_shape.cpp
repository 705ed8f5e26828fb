#include "shared/las/file_shape.hpp"

#include "shared/base/text.hpp"
#include "shared/las/extra_bytes.hpp"
#include "shared/las/las_records.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stipple::las {

namespace {

Error invalid(std::string what, std::string advice = "") {
    return {ErrorCode::invalidArgument, std::move(what), "", std::move(advice)};
}

// The type of a LAS attribute, whichever format has it.
const Attribute* lasAttribute(std::string_view name) {
    static const std::array<Schema, 2> all{schemaOf(5), schemaOf(10)};
    for (const Schema& schema : all)
        if (int index = schema.find(name); index >= 0)
            return &schema.attributes[static_cast<std::size_t>(index)];
    return nullptr;
}

// The lowest format that has most (where possible all) of the schema's LAS attributes.
int choosePointFormat(const Schema& schema) {
    int best = 0;
    std::ptrdiff_t mostHeld = -1;
    for (int format = 0; format <= 10; ++format) {
        Schema fields = schemaOf(format);
        auto held = std::count_if(schema.attributes.begin(), schema.attributes.end(),
                                  [&](const Attribute& a) { return fields.find(a.name) >= 0; });
        if (held > mostHeld) {
            best = format;
            mostHeld = held;
        }
    }
    return best;
}

Result<RecordPlan> planRecords(const Schema& schema, int pointFormat) {
    RecordPlan plan{baseLayout(pointFormat), {}, {}};
    // The undescribed remainder is recognised only at the end; elsewhere its bytes get a descriptor.
    std::size_t tail = schema.attributes.size();
    while (tail > 0 && isUndescribed(schema.attributes[tail - 1]))
        --tail;
    for (std::size_t a = 0; a < schema.attributes.size(); ++a) {
        const Attribute& attribute = schema.attributes[a];
        const Attribute* field = lasAttribute(attribute.name);
        if (field && (field->type != attribute.type || attribute.components != 1))
            return invalid(cat("LAS stores \"", attribute.name, "\" as one ", attributeTypeName(field->type),
                               ", but it is ", attribute.components, " × ",
                               attributeTypeName(attribute.type)),
                           "give the attribute another name");
        if (auto place = findField(plan.layout, attribute.name)) {
            plan.columns.push_back({a, *place});
            continue;
        }
        plan.columns.push_back({a, {a, plan.layout.recordLength, attribute.size(), 0, 0}});
        plan.layout.recordLength += attribute.size();
        if (a < tail)
            plan.described.push_back(a);
    }
    if (plan.layout.recordLength > std::numeric_limits<std::uint16_t>::max())
        return invalid(
            cat("a point record of ", plan.layout.recordLength, " bytes is longer than LAS allows"));
    if (plan.described.size() * extraBytesDescriptorSize > maxVlrData)
        return invalid(cat(plan.described.size(), " extra attributes are more than the ",
                           maxVlrData / extraBytesDescriptorSize, " that LAS describes"));
    return plan;
}

int chooseVersionMinor(const WriterOptions& options, int pointFormat, const RecordPlan& plan) {
    bool extended = std::any_of(options.vlrs.begin(), options.vlrs.end(),
                                [](const Vlr& vlr) { return vlr.extended || vlr.data.size() > maxVlrData; });
    if (!options.wkt.empty() || !plan.described.empty() || extended ||
        options.expectedPoints > maxLegacyCount)
        return 4;
    int minor = 2;
    while (highestPointFormat(minor) < pointFormat)
        ++minor;
    return minor;
}

Status checkOptions(const WriterOptions& options) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(options.grid.scale[axis] > 0) || !std::isfinite(options.grid.scale[axis]) ||
            !std::isfinite(options.grid.offset[axis]))
            return invalid(cat("the ", "xyz"[axis], " scale ", options.grid.scale[axis], " and offset ",
                               options.grid.offset[axis], " make no grid"));
    if (options.pointFormat < -1 || options.pointFormat > 10)
        return invalid(cat("point format ", options.pointFormat, " is not one of 0 to 10"));
    if (options.versionMinor < -1 || options.versionMinor > 4)
        return invalid(cat("LAS 1.", options.versionMinor, " is not one of 1.0 to 1.4"));
    for (std::size_t a = 0; a < options.schema.attributes.size(); ++a) {
        const Attribute& attribute = options.schema.attributes[a];
        if (attribute.components < 1 || attribute.components > 255)
            return invalid(cat("\"", attribute.name, "\" has ", attribute.components, " components"));
        if (options.schema.find(attribute.name) != static_cast<int>(a))
            return invalid(cat("two attributes are named \"", attribute.name, "\""));
    }
    for (const Vlr& vlr : options.vlrs) {
        if (vlr.is(records::projection, records::wkt) || vlr.is(records::spec, records::extraBytes) ||
            vlr.is(records::laszip, records::laszipRecord))
            return invalid(cat("the record ", vlr.userId, " ", vlr.recordId, " is written by itself"));
        if (vlr.omitted)
            return invalid(cat("the data of the record ", vlr.userId, " ", vlr.recordId, " were not loaded"));
    }
    return {};
}

} // namespace

Result<FileShape> shapeOf(const WriterOptions& options) {
    STIPPLE_CHECK(checkOptions(options));
    FileShape shape;
    shape.pointFormat = options.pointFormat >= 0 ? options.pointFormat : choosePointFormat(options.schema);
    STIPPLE_TRY(plan, planRecords(options.schema, shape.pointFormat));
    shape.plan = std::move(plan);
    shape.versionMinor = options.versionMinor >= 0
                             ? options.versionMinor
                             : chooseVersionMinor(options, shape.pointFormat, shape.plan);
    if (highestPointFormat(shape.versionMinor) < shape.pointFormat)
        return invalid(cat("LAS 1.", shape.versionMinor, " has no point format ", shape.pointFormat));
    return shape;
}

SummaryColumns summaryColumns(const RecordPlan& plan, const Schema& schema, int pointFormat) {
    return {pointFormat, schema.find(attribute_names::returnNumber), plan.described};
}

} // namespace stipple::las
