// The region scans of a session.
//
// Thread: the session's.
#pragma once

#include "client/core/region_scan.hpp"

#include <map>
#include <memory>

namespace stipple {

class RegionScans {
  public:
    Result<RegionScanId> start(const CloudLoader& cloud, const RegionRequest& request);
    void end(RegionScanId id) { scans_.erase(id); } // nothing happens where there is none
    RegionScan* find(RegionScanId id);
    const RegionScan* find(RegionScanId id) const;

    // True if something else is to be asked for than before.
    bool advance(const CloudMap& clouds);
    bool mustGoOn() const;
    std::vector<LoadItem> items(const CloudMap& clouds, NodeCache& cache) const;
    void takeLoaded(const CloudLoader& cloud, const LoadItem& item, Result<Bytes> bytes);
    // Ends the scans of a cloud that is gone, or is another file now.
    void fail(CloudId cloud, const Error& error);

  private:
    std::map<RegionScanId, std::unique_ptr<RegionScan>> scans_;
    RegionScanId last_ = 0;
};

} // namespace stipple
