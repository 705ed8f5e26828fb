// The one schema of a cloud made from inputs with several: the union of their attributes.
//
// Attributes of the same name and meaning are one. Where inputs give one name to different things (another
// type, another scale), each becomes an attribute of its own, named "Name (uint16)", or, where the type does
// not tell them apart, "Name (uint16, scale 0.01, offset 0)". A point that lacks an attribute has 0 there.
#pragma once

#include "shared/points/attribute.hpp"

#include <string>
#include <vector>

namespace stipple {

struct CommonSchema {
    Schema schema;
    // sources[input][attribute of schema]: index in that input's schema, or -1.
    std::vector<std::vector<int>> sources;
};

// Does not depend on the order of `inputs` (except for the order of `sources`): a schema that all inputs
// share stays as it is; else attributes go by the order of the LAS tables, then by name.
CommonSchema commonSchema(const std::vector<Schema>& inputs);

} // namespace stipple
