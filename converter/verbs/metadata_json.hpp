// The parts of a cloud's description that the verbs' --json outputs share.
#pragma once

#include "shared/format/cloud_metadata.hpp"

#include <nlohmann/json.hpp>

namespace stipple::cli {

using Json = nlohmann::ordered_json; // people read it: keys stay in the order they are written

const char* colourName(PictureColour colour); // as in the file
Json vectorJson(const Vec3d& v);
Json boxJson(const BoxD& box); // null for an empty box
Json gridJson(const Grid& grid);
Json crsJson(const Crs& crs); // null where none is known
Json attributeJson(const Attribute& attribute);
Json metadataJson(const CloudMetadata& metadata);

// One JSON object on standard output; text that is no UTF-8 is replaced.
void printJson(const Json& json);

// "none known", or name and EPSG code.
std::string crsText(const Crs& crs);

} // namespace stipple::cli
