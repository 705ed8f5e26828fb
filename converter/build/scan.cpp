#include "converter/build/scan.hpp"

#include "converter/build/common_schema.hpp"
#include "converter/crs/crs.hpp"
#include "converter/input/file_identity.hpp"
#include "converter/input/reproject.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace stipple {

namespace {
Status refuseDoubles(const std::vector<std::string>& paths) {
    std::map<FileIdentity, const std::string*> seen;
    for (const std::string& path : paths) {
        std::optional<FileIdentity> identity = fileIdentity(path);
        if (!identity)
            continue; // opening it says what is wrong
        auto [known, isNew] = seen.emplace(*identity, &path);
        if (!isNew)
            return Error{ErrorCode::invalidArgument,
                         cat("the input is given twice",
                             *known->second == path ? "" : cat(": it is the same file as ", *known->second)),
                         path, "name it once"};
    }
    return {};
}

bool sameMeaning(const Attribute& a, const Attribute& b) {
    auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
    return a.type == b.type && a.components == b.components && same(a.scale, b.scale) &&
           same(a.offset, b.offset) && a.noData.has_value() == b.noData.has_value() &&
           (!a.noData || same(*a.noData, *b.noData));
}

// Heights that only one of the two defines are no difference.
bool sameCrs(const Crs& a, const Crs& b) {
    if (!a.vertical.empty() && !b.vertical.empty() && a.vertical != b.vertical)
        return false;
    if (a.epsg && b.epsg)
        return *a.epsg == *b.epsg;
    return a.wkt == b.wkt || (!a.name.empty() && a.name == b.name);
}

// Of several texts for one system the first holds, in any order of inputs: one with heights, then by text.
bool comesBefore(const Crs& a, const Crs& b) {
    if (a.vertical.empty() != b.vertical.empty())
        return !a.vertical.empty();
    return !a.wkt.empty() && (b.wkt.empty() || a.wkt < b.wkt);
}

// "a.las", "a.las and 11 more inputs"
class Named {
  public:
    void add(const std::string& path) {
        if (count_++ == 0)
            first_ = path;
    }
    bool any() const { return count_ > 0; }
    std::string text() const {
        return count_ <= 1 ? first_ : cat(first_, " and ", count_ - 1, " more input", count_ > 2 ? "s" : "");
    }

  private:
    std::string first_;
    std::size_t count_ = 0;
};

// The CRS that all inputs that state one are in.
Result<Crs> statedCrs(const std::vector<ScannedInput>& inputs) {
    Crs common;
    std::string from;
    for (const ScannedInput& input : inputs) {
        const InputDescription& stated = input.description();
        if (!stated.crs.known())
            continue;
        if (!common.known()) {
            common = stated.crs;
            from = stated.path;
        } else if (!sameCrs(common, stated.crs)) {
            return Error{
                ErrorCode::invalidArgument,
                cat("its CRS is ", crsTitle(stated.crs), ", but that of ", from, " is ", crsTitle(common)),
                stated.path, "--crs EPSG:n brings all inputs into one"};
        } else if (comesBefore(stated.crs, common)) {
            common = stated.crs;
        }
    }
    return common;
}

// Inputs of one CRS that are to be brought into another.
struct Journey {
    Crs from;
    BoxD area; // of all of them, so that they go the same way
    Named inputs;
    double coarsestStep = 0;
    std::shared_ptr<const CrsTransformation> transformation;
};

std::string journeyText(const Journey& journey, const Crs& to) {
    const CrsTransformation::Facts& facts = journey.transformation->facts();
    std::string text = cat(journey.inputs.text(), ": reprojected from ", crsTitle(journey.from), " to ",
                           crsTitle(to), " (", facts.operation, "); ");
    if (!facts.accuracyMeters)
        text += "how exact that is is unknown to PROJ";
    else if (*facts.accuracyMeters == 0)
        text += "exact but for rounding";
    else
        text += cat("exact to ", *facts.accuracyMeters, " m, as PROJ states");
    if (facts.isBallpark)
        text +=
            ", and without a shift between datums, as PROJ has none: points may lie metres to hundreds of "
            "metres off";
    text += cat("; x and y are rounded by at most ", journey.coarsestStep / 2, " ", to.unit, "; heights are ",
                facts.keepsHeights ? "kept" : "transformed, too");
    bool otherUnit = journey.from.unitMeters != to.unitMeters && journey.from.unitMeters > 0;
    if (facts.keepsHeights && otherUnit && journey.from.unitMeters != 1 && journey.from.vertical.empty())
        text += cat(" in their unit, which may be ", journey.from.unit);
    return text;
}

// Wraps every input of another CRS in its reprojection.
Status bringInto(const Crs& to, std::vector<ScannedInput>& inputs, std::vector<std::string>& warnings) {
    std::map<std::string, Journey> journeys;
    auto keyOf = [](const Crs& crs) { return cat(crs.epsg.value_or(0), " ", crs.vertical, " ", crs.wkt); };
    auto mustGo = [&](const ScannedInput& input) {
        return input.description().crs.known() && !sameCrs(input.description().crs, to);
    };
    for (const ScannedInput& input : inputs) {
        if (!mustGo(input))
            continue;
        const InputDescription& d = input.description();
        Journey& journey = journeys[keyOf(d.crs)];
        journey.from = d.crs;
        journey.inputs.add(d.path);
        if (!d.bounds.empty()) {
            journey.area.extend(d.grid.toWorld(d.bounds.min));
            journey.area.extend(d.grid.toWorld(d.bounds.max));
        }
    }
    for (auto& [key, journey] : journeys) {
        STIPPLE_TRY(transformation, CrsTransformation::create(journey.from, to, journey.area));
        journey.transformation = std::move(transformation);
    }
    for (ScannedInput& input : inputs) {
        if (!mustGo(input))
            continue;
        Journey& journey = journeys[keyOf(input.description().crs)];
        STIPPLE_TRY(reprojected, reprojectInput(std::move(input.input), journey.transformation, to));
        input.input = std::move(reprojected);
        journey.coarsestStep = std::max(journey.coarsestStep, input.description().grid.scale.x);
    }
    for (const auto& [key, journey] : journeys)
        warnings.push_back(journeyText(journey, to));
    return {};
}

// The CRS of the cloud; inputs of others are brought into it.
Result<Crs> settleCrs(std::vector<ScannedInput>& inputs, const ScanOptions& options,
                      std::vector<std::string>& warnings) {
    Crs common;
    if (options.target) {
        common = *options.target;
    } else if (!options.crs.empty()) {
        STIPPLE_TRY(crs, crsFromUser(options.crs));
        common = crs;
    } else {
        STIPPLE_TRY(crs, statedCrs(inputs));
        common = crs;
    }
    if (!common.known()) {
        warnings.push_back("no input states a coordinate reference system; --crs EPSG:n sets it");
        return common;
    }
    Named without;
    for (const ScannedInput& input : inputs)
        if (!input.description().crs.known())
            without.add(input.description().path);
    if (without.any())
        warnings.push_back(cat(without.text(), ": no CRS stated; taken to be ", crsTitle(common)));
    STIPPLE_CHECK(bringInto(common, inputs, warnings));
    return common;
}

void reportMissingAttributes(const Scan& scan, std::vector<std::string>& warnings) {
    for (const ScannedInput& input : scan.inputs) {
        std::string missing;
        for (std::size_t a = 0; a < input.attributeSources.size(); ++a)
            if (input.attributeSources[a] < 0)
                missing += cat(missing.empty() ? "" : ", ", scan.schema.attributes[a].name);
        if (!missing.empty())
            warnings.push_back(
                cat(input.description().path, ": filled with 0, as the file does not have it: ", missing));
    }
}

// LAS keeps what GPS times count from in the file's header; a cloud keeps it in the attribute.
void describeGpsTime(Scan& scan) {
    int attribute = scan.schema.find(attribute_names::gpsTime);
    bool standard = false, week = false;
    for (const ScannedInput& input : scan.inputs) {
        standard = standard || input.description().gpsTime == GpsTimeKind::adjustedStandard;
        week = week || input.description().gpsTime == GpsTimeKind::week;
    }
    if (attribute < 0 || standard == week) {
        if (attribute >= 0 && standard)
            scan.warnings.push_back(
                "some inputs hold adjusted standard GPS times, others GPS week times; they "
                "are kept as they are");
        return;
    }
    scan.schema.attributes[static_cast<std::size_t>(attribute)].description =
        standard ? standardGpsTimeText : weekGpsTimeText;
}

} // namespace

Result<Scan> scanInputs(const std::vector<std::string>& paths, const ScanOptions& options) {
    Scan scan;
    if (paths.empty())
        return Error{ErrorCode::invalidArgument, "there is no input", "", "name at least one file"};
    STIPPLE_CHECK(refuseDoubles(paths));
    for (const std::string& path : paths) {
        if (options.input.stop && *options.input.stop)
            return Error{ErrorCode::cancelled, "interrupted", "", ""};
        STIPPLE_TRY(input, openInput(path, options.input));
        for (const std::string& warning : input->description().warnings)
            scan.warnings.push_back(cat(path, ": ", warning));
        scan.inputs.emplace_back().input = std::move(input);
    }
    STIPPLE_TRY(crs, settleCrs(scan.inputs, options, scan.warnings));
    scan.crs = crs;
    std::vector<Grid> grids;
    std::vector<BoxI> boxes;
    std::vector<Schema> schemas;
    for (const ScannedInput& input : scan.inputs) {
        scan.pointCount += input.description().source.pointCount;
        grids.push_back(input.description().grid);
        boxes.push_back(input.description().bounds);
        schemas.push_back(input.description().schema);
    }
    scan.grid = commonGrid(grids, boxes);
    CommonSchema common = commonSchema(schemas);
    scan.schema = common.schema;
    for (std::size_t i = 0; i < scan.inputs.size(); ++i) {
        scan.inputs[i].toCloud = gridMap(grids[i], scan.grid);
        scan.inputs[i].attributeSources = common.sources[i];
    }
    reportMissingAttributes(scan, scan.warnings);
    describeGpsTime(scan);
    return scan;
}

std::vector<UnmatchedAttribute> mapOnto(Scan& scan, const Grid& grid, const Schema& schema) {
    std::vector<UnmatchedAttribute> unmatched;
    std::vector<int> merged(schema.attributes.size(), -1); // for each of the cloud's: index in the scan's
    for (std::size_t a = 0; a < scan.schema.attributes.size(); ++a) {
        const Attribute& wanted = scan.schema.attributes[a];
        int found = schema.find(wanted.name);
        if (found >= 0 && sameMeaning(schema.attributes[static_cast<std::size_t>(found)], wanted)) {
            merged[static_cast<std::size_t>(found)] = static_cast<int>(a);
            continue;
        }
        UnmatchedAttribute attribute{wanted.name, found < 0, {}};
        for (const ScannedInput& input : scan.inputs) {
            int source = input.attributeSources[a];
            attribute.sources.push_back(source);
            if (source >= static_cast<int>(input.description().imposedAttributes))
                attribute.imposed = false;
        }
        unmatched.push_back(std::move(attribute));
    }
    for (ScannedInput& input : scan.inputs) {
        std::vector<int> sources;
        for (int a : merged)
            sources.push_back(a < 0 ? -1 : input.attributeSources[static_cast<std::size_t>(a)]);
        input.attributeSources = std::move(sources);
        input.toCloud = gridMap(input.description().grid, grid);
    }
    scan.grid = grid;
    scan.schema = schema;
    return unmatched;
}

} // namespace stipple
