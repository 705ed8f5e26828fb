#include "server/upstream/upstream.hpp"

#include "client/headless/tls_trust.hpp"

namespace stipple::server {

Result<std::shared_ptr<Upstream>> Upstream::open(const UpstreamOptions& options) {
    STIPPLE_TRY(trust, TlsTrust::load(options.caPath));
    std::unique_ptr<DiskBlocks> disk;
    if (!options.diskFolder.empty()) {
        STIPPLE_TRY(opened, DiskBlocks::open(options.diskFolder, options.diskBytes));
        disk = std::move(opened);
    }
    std::shared_ptr<Upstream> upstream(new Upstream(options, trust, std::move(disk)));
    STIPPLE_CHECK(upstream->reloadTokens());
    return upstream;
}

std::string Upstream::tokenFor(const std::string& origin) const {
    std::lock_guard lock(tokensMutex_);
    return tokens_.of(origin);
}

Status Upstream::reloadTokens() {
    if (options.tokenPath.empty())
        return {};
    STIPPLE_TRY(loaded, UpstreamTokens::load(options.tokenPath));
    std::lock_guard lock(tokensMutex_);
    tokens_ = std::move(loaded);
    return {};
}

std::vector<Measurement> Upstream::measurements() const {
    auto counter = [](const char* name, const char* help, const std::atomic<std::uint64_t>& value) {
        return Measurement{name, help, true, static_cast<double>(value.load())};
    };
    std::vector<Measurement> all{
        counter("stipple_upstream_requests_total", "Ranges asked of other servers", counts.requests),
        counter("stipple_upstream_bytes_total", "Bytes that came from other servers", counts.bytes),
        counter("stipple_upstream_failures_total", "Ranges that other servers did not answer",
                counts.failures),
        counter("stipple_upstream_timeouts_total", "Of those, for lack of an answer in time",
                counts.timeouts),
        counter("stipple_upstream_changes_total", "Clouds found replaced or removed at other servers",
                counts.changes)};
    if (disk) {
        all.push_back({"stipple_upstream_disk_damaged_total",
                       "Blocks on disk that were dropped for what was in them", true,
                       static_cast<double>(disk->damaged())});
        all.push_back({"stipple_upstream_disk_failures_total", "Blocks that the disk refused", true,
                       static_cast<double>(disk->failures())});
    }
    return all;
}

} // namespace stipple::server
