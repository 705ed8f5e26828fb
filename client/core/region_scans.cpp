#include "client/core/region_scans.hpp"

#include <algorithm>
#include <iterator>

namespace stipple {

Result<RegionScanId> RegionScans::start(const CloudLoader& cloud, const RegionRequest& request) {
    STIPPLE_TRY(scan, RegionScan::make(last_ + 1, cloud, request));
    scans_[++last_] = std::move(scan);
    return last_;
}

RegionScan* RegionScans::find(RegionScanId id) {
    auto at = scans_.find(id);
    return at == scans_.end() ? nullptr : at->second.get();
}
const RegionScan* RegionScans::find(RegionScanId id) const {
    auto at = scans_.find(id);
    return at == scans_.end() ? nullptr : at->second.get();
}

bool RegionScans::advance(const CloudMap& clouds) {
    bool asksMore = false;
    for (auto& [id, scan] : scans_)
        if (auto cloud = clouds.find(scan->cloud()); cloud != clouds.end())
            asksMore |= scan->advance(cloud->second);
    return asksMore;
}

bool RegionScans::mustGoOn() const {
    return std::any_of(scans_.begin(), scans_.end(),
                       [](const auto& scan) { return scan.second->mustGoOn(); });
}

std::vector<LoadItem> RegionScans::items(const CloudMap& clouds, NodeCache& cache) const {
    std::vector<LoadItem> items;
    for (const auto& [id, scan] : scans_)
        if (auto cloud = clouds.find(scan->cloud()); cloud != clouds.end() && cloud->second.ready()) {
            std::vector<LoadItem> more = scan->items(cloud->second, cache);
            std::move(more.begin(), more.end(), std::back_inserter(items));
        }
    return items;
}

void RegionScans::takeLoaded(const CloudLoader& cloud, const LoadItem& item, Result<Bytes> bytes) {
    if (RegionScan* scan = find(item.key.block); scan && scan->cloud() == cloud.state.id)
        scan->takeLoaded(item, bytes.ok() ? std::move(bytes) : Result<Bytes>(cloud.placed(bytes.error())));
}

void RegionScans::fail(CloudId cloud, const Error& error) {
    for (auto& [id, scan] : scans_)
        if (scan->cloud() == cloud)
            scan->fail(error);
}

} // namespace stipple
