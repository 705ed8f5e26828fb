// The parts of a filter as users write them, on a command line or in an address.
#pragma once

#include "converter/export/point_filter.hpp"
#include "shared/base/result.hpp"
#include "shared/points/attribute.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace stipple {

// "xmin,ymin,xmax,ymax" (any z) or "xmin,ymin,zmin,xmax,ymax,zmax". invalidArgument for anything else.
Result<BoxD> boxFromText(std::string_view text);
// "2,6,40-45": stored values and closed ranges of them. Whole numbers, none negative.
Result<std::vector<ValueRange>> rangesFromText(std::string_view text);
// Names joined by commas, as indices of a schema; a name that holds a comma is found too if it is given alone
// in one of the texts. Each attribute once, in the order given.
Result<std::vector<int>> attributesFromTexts(const Schema& schema, const std::vector<std::string>& texts);

} // namespace stipple
