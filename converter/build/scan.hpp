// Phase 1: what the inputs are, from their headers, and what the cloud made of them will be.
#pragma once

#include "converter/build/common_grid.hpp"
#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/io/byte_source.hpp"
#include "shared/las/las_reader.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stipple {

struct ScannedInput {
    std::string path;
    SourceFile source; // source.pointCount: points that are really there
    Grid grid;
    Schema schema;
    Crs crs;
    las::Header header; // without its records

    // How its points become the cloud's.
    GridMap toCloud;
    std::vector<int> attributeSources; // for each of the cloud's attributes: index in `schema`, or -1
};

struct Scan {
    std::vector<ScannedInput> inputs; // in the order of the paths
    Grid grid;
    Schema schema;
    Crs crs;
    std::uint64_t pointCount = 0;
    std::vector<std::string> warnings;
};

// Opens every input and reads its header. Inputs are told by their first bytes, not by their names. `crs`
// ("EPSG:n" or empty) is for inputs that state none. Errors name the file: missing, a folder, no LAS file,
// LAZ (unsupported as yet), given twice, another CRS than the others.
Result<Scan> scanInputs(const std::vector<std::string>& paths, const std::string& crs);

// Lets the scanned points be read as points of another cloud (to compare with it). Attributes go by name;
// those that the cloud lacks, or has with another type or scale, are returned by name.
std::vector<std::string> mapOnto(Scan& scan, const Grid& grid, const Schema& schema);

// What a cloud's GPS Time counts from (LAS: global encoding, bit 0) is the attribute's description.
inline constexpr const char* standardGpsTimeText = "adjusted standard GPS time";
inline constexpr const char* weekGpsTimeText = "GPS week time";

// A LAS input and the bytes behind it.
struct OpenInput {
    std::unique_ptr<ByteSource> source;
    std::unique_ptr<las::Reader> reader;
};
Result<OpenInput> openInput(const std::string& path);

} // namespace stipple
