// What takes the points of a region, in batches, and makes something of them.
#pragma once

#include "client/region/piece_sink.hpp"
#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/points/point_batch.hpp"
#include "shared/select/cloud_filter.hpp"

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <string>
#include <vector>

namespace stipple {

class PointTaker {
  public:
    virtual ~PointTaker() = default;
    // batch.columns[i] is attributes()[i].
    virtual Status take(PointBatch batch) = 0;
    // All points have come; what there is to say of them.
    virtual Result<nlohmann::json> finish() = 0;
    // The attributes it takes: those of PointChooser::make().
    virtual const std::vector<int>& attributes() const = 0;
};

// The text of a field; empty where there is none.
std::string textField(const nlohmann::json& request, const char* name);

using Metadata = std::shared_ptr<const CloudMetadata>;

// A file. Fields: "format": "las", "laz" or "csv"; "attributes": names, absent: all. Where the filter has a
// corridor, points have their station and offset, too. Its bytes go to `pieces`. Says "points", "bytes",
// "warnings".
Result<std::unique_ptr<PointTaker>> fileTaker(const Metadata& metadata, const CloudFilter& filter,
                                              const nlohmann::json& request, std::shared_ptr<Pieces> pieces);

// The points of a profile, for a picture of it: after each batch `pieces` have, little-endian,
//
//   uint32 count, uint32 0
//   float64[count] each: station, offset, x, y, z
//   uint32[count] colour 0xAABBGGRR, uint32[count] classification and, from bit 8, return number
//   float32[count] intensity
//
// What the cloud lacks is grey, or 0.
Result<std::unique_ptr<PointTaker>> profileTaker(const Metadata& metadata, const CloudFilter& filter,
                                                 std::shared_ptr<Pieces> pieces);

// How many there are: "points", as every work says.
std::unique_ptr<PointTaker> countTaker();

// Cut and fill within a polygon (client/survey/volumes.hpp). Fields: "points": corners as measuring has them
// (client/survey/measure_json.hpp), "geocentric", "base": "rim" or {"height": z} or {"point": […as one of
// points]}, a level plane there; "cell": side of the cells, absent: twice the mean distance of the points.
// Says "cut", "fill", "net", "area", each with "±", "areaWithoutPoints", "pointsInside", "cell".
Result<std::unique_ptr<PointTaker>> volumeTaker(const Metadata& metadata, const nlohmann::json& request);
// The region that a volume takes its points from (shared/select/region_json.hpp).
Result<nlohmann::json> volumeRegion(const nlohmann::json& request);

} // namespace stipple
