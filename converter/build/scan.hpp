// Phase 1: what the inputs are, from their headers, and what the cloud made of them will be.
#pragma once

#include "converter/input/common_grid.hpp"
#include "converter/input/open.hpp"
#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stipple {

struct ScannedInput {
    std::unique_ptr<PointInput> input;

    // How its points become the cloud's.
    GridMap toCloud;
    std::vector<int> attributeSources; // for each of the cloud's attributes: index in the input's, or -1

    const InputDescription& description() const { return input->description(); }
};

struct Scan {
    std::vector<ScannedInput> inputs; // in the order of the paths
    Grid grid;
    Schema schema;
    Crs crs;
    std::uint64_t pointCount = 0;
    std::vector<std::string> warnings;
};

struct ScanOptions {
    // The cloud's CRS, as a user names it ("EPSG:n"): inputs that state another are reprojected to it, those
    // that state none are taken to be in it. Empty: what the inputs state, which must then be the same.
    std::string crs = {};
    std::optional<Crs> target = {}; // the same, already known; goes before `crs`
    InputOptions input = {};
};

// Opens every input and reads what it says of itself. Errors name the file: those of openInput; given twice,
// another CRS than the others
// (and none named in the options), a CRS that can't be reached by PROJ. Warnings say what was reprojected and
// how exactly.
Result<Scan> scanInputs(const std::vector<std::string>& paths, const ScanOptions& options);

// An attribute of the inputs that a cloud lacks, or has with another type or scale.
struct UnmatchedAttribute {
    std::string name;
    // The cloud has none of that name, and every input that has it is of a format that can't leave it out.
    bool imposed = false;
    std::vector<int> sources; // for each input: index in its own schema, or -1
};

// Lets the scanned points be read as points of another cloud (to compare with it). Attributes go by name;
// those that the cloud has no equal of are returned, and left out.
std::vector<UnmatchedAttribute> mapOnto(Scan& scan, const Grid& grid, const Schema& schema);

} // namespace stipple
