// The work that is done with a region's points, apart from reading them: a worker of the page runs it on the
// nodes that a scan (client/core/region_scan.hpp) delivers.
//
//   {"make": "file" | "profile" | "volume" | "count", "region": {…}, …}
//
// Regions are those of shared/select/region_json.hpp; further fields, and what comes of them, those of
// point_taker.hpp. A volume makes its region itself.
//
// Thread: one at a time.
#pragma once

#include "client/region/point_taker.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/select/point_chooser.hpp"

#include <nlohmann/json.hpp>

namespace stipple {

class RegionWork {
  public:
    // Errors: invalidArgument, naming what is wrong with the request; what a format can't hold.
    static Result<std::unique_ptr<RegionWork>> make(std::shared_ptr<const CloudMetadata> metadata,
                                                    const nlohmann::json& request);

    // What the scan has to be asked for: {"region": {…}, "attributes": [indices]}.
    const nlohmann::json& scan() const { return scan_; }
    // A node of the scan. Errors: those of decoding, and limitExceeded for more points than
    // "mostPoints" allows (absent: any number).
    Status take(NodeBytes node, bool tested);
    // {"points": wanted ones, …}
    Result<nlohmann::json> finish();
    std::uint64_t points() const { return points_; } // wanted ones so far
    Pieces& pieces() { return *pieces_; }
    // What NodeBytes::attributes has to be.
    const std::vector<int>& attributesToRead(bool tested) const { return chooser_->attributesToRead(tested); }

  private:
    RegionWork() = default;
    std::shared_ptr<const CloudMetadata> metadata_;
    std::unique_ptr<CloudFilter> filter_;
    std::unique_ptr<PointChooser> chooser_;
    std::unique_ptr<PointTaker> taker_;
    std::shared_ptr<Pieces> pieces_ = std::make_shared<Pieces>();
    nlohmann::json scan_;
    std::uint64_t points_ = 0, mostPoints_ = 0;
};

} // namespace stipple
