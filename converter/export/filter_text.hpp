// The parts of a filter as users write them, on a command line or in an address.
#pragma once

#include "shared/base/result.hpp"
#include "shared/points/attribute.hpp"
#include "shared/select/point_filter.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace stipple {

// "xmin,ymin,xmax,ymax" (any z) or "xmin,ymin,zmin,xmax,ymax,zmax". invalidArgument for anything else.
Result<BoxD> boxFromText(std::string_view text);
// "2,6,40-45": stored values and closed ranges of them. Whole numbers, none negative.
Result<std::vector<ValueRange>> rangesFromText(std::string_view text);
// "1,2.5,-3e4": finite numbers.
Result<std::vector<double>> numbersFromText(std::string_view text);
// "low..high", "low.." or "..high", or one value: a closed range, infinite where it is open. Finite numbers.
Result<ValueRange> rangeFromText(std::string_view text);
// "Intensity:100..2000;Return Number:1,3..": conditions on what values mean (AttributeCondition::ofMeaning),
// joined by semicolons; each a name, a colon and ranges joined by commas. Names may hold semicolons and
// colons. Whether there are such attributes is not looked at.
Result<std::vector<AttributeCondition>> conditionsFromText(std::string_view text);
// "x,y;x,y;…": at least two points.
Result<std::vector<Point2d>> lineFromText(std::string_view text);
// "x,y,z;dx,dy,dz;rotation": rotatedBox() (region_options.hpp), the rotation left out or not.
Result<std::shared_ptr<const ConvexRegion>> rotatedBoxFromText(std::string_view text);
// Names joined by commas, as indices of a schema; a name that holds a comma is found too if it is given alone
// in one of the texts. Each attribute once, in the order given.
Result<std::vector<int>> attributesFromTexts(const Schema& schema, const std::vector<std::string>& texts);

} // namespace stipple
