#include "converter/build/scan.hpp"

#include "converter/build/common_schema.hpp"
#include "converter/crs/crs.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

namespace stipple {

namespace {
Status refuseDoubles(const std::vector<std::string>& paths) {
    std::set<std::string> seen;
    for (const std::string& path : paths) {
        std::error_code error;
        std::filesystem::path real = std::filesystem::canonical(path, error);
        if (error)
            continue; // opening it says what is wrong
        if (!seen.insert(real.string()).second)
            return Error{ErrorCode::invalidArgument, "the input is given twice", path, "name it once"};
    }
    return {};
}

bool sameMeaning(const Attribute& a, const Attribute& b) {
    auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
    return a.type == b.type && a.components == b.components && same(a.scale, b.scale) &&
           same(a.offset, b.offset) && a.noData.has_value() == b.noData.has_value() &&
           (!a.noData || same(*a.noData, *b.noData));
}

bool sameCrs(const Crs& a, const Crs& b) {
    if (a.epsg && b.epsg)
        return *a.epsg == *b.epsg;
    return a.wkt == b.wkt || (!a.name.empty() && a.name == b.name);
}

std::string crsText(const Crs& crs) {
    std::string name = crs.name.empty() ? "an unnamed system" : crs.name;
    return crs.epsg ? cat(name, " (EPSG:", *crs.epsg, ")") : name;
}

// The CRS of the cloud, and of inputs that state none.
Result<Crs> commonCrs(const std::vector<ScannedInput>& inputs, const std::string& wanted,
                      std::vector<std::string>& warnings) {
    Crs common;
    std::string from;
    if (!wanted.empty()) {
        STIPPLE_TRY(crs, crsFromUser(wanted));
        common = crs;
        from = "--crs";
    }
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
                cat("its CRS is ", crsText(stated.crs), ", but that of ", from, " is ", crsText(common)),
                stated.path, "bring the inputs into one CRS first"};
        } else if (common.wkt != stated.crs.wkt && !stated.crs.wkt.empty() &&
                   (common.wkt.empty() || stated.crs.wkt < common.wkt)) {
            common = stated.crs; // of several texts for one system the first by text, in any order of inputs
        }
    }
    if (!common.known() && !inputs.empty())
        warnings.push_back("no input states a coordinate reference system; --crs EPSG:n sets it");
    for (const ScannedInput& input : inputs)
        if (common.known() && !input.description().crs.known() && wanted.empty())
            warnings.push_back(
                cat(input.description().path, ": states no CRS; taken to be ", crsText(common)));
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
    std::vector<Grid> grids;
    std::vector<Schema> schemas;
    for (const std::string& path : paths) {
        STIPPLE_TRY(input, openInput(path, options.input));
        const InputDescription& description = input->description();
        for (const std::string& warning : description.warnings)
            scan.warnings.push_back(cat(path, ": ", warning));
        scan.pointCount += description.source.pointCount;
        grids.push_back(description.grid);
        schemas.push_back(description.schema);
        scan.inputs.emplace_back().input = std::move(input);
    }
    scan.grid = commonGrid(grids);
    CommonSchema common = commonSchema(schemas);
    scan.schema = common.schema;
    for (std::size_t i = 0; i < scan.inputs.size(); ++i) {
        scan.inputs[i].toCloud = gridMap(grids[i], scan.grid);
        scan.inputs[i].attributeSources = common.sources[i];
    }
    STIPPLE_TRY(crsOfAll, commonCrs(scan.inputs, options.crs, scan.warnings));
    scan.crs = crsOfAll;
    reportMissingAttributes(scan, scan.warnings);
    describeGpsTime(scan);
    return scan;
}

std::vector<std::string> mapOnto(Scan& scan, const Grid& grid, const Schema& schema) {
    std::vector<std::string> different;
    for (std::size_t a = 0; a < scan.schema.attributes.size(); ++a) {
        const Attribute& wanted = scan.schema.attributes[a];
        int found = schema.find(wanted.name);
        if (found < 0 || !sameMeaning(schema.attributes[static_cast<std::size_t>(found)], wanted))
            different.push_back(wanted.name);
    }
    for (ScannedInput& input : scan.inputs) {
        std::vector<int> sources(schema.attributes.size(), -1);
        for (std::size_t a = 0; a < schema.attributes.size(); ++a) {
            const Attribute& attribute = schema.attributes[a];
            int merged = scan.schema.find(attribute.name);
            if (merged >= 0 &&
                std::find(different.begin(), different.end(), attribute.name) == different.end())
                sources[a] = input.attributeSources[static_cast<std::size_t>(merged)];
        }
        input.attributeSources = std::move(sources);
        input.toCloud = gridMap(input.description().grid, grid);
    }
    scan.grid = grid;
    scan.schema = schema;
    return different;
}

} // namespace stipple
