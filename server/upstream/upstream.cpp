#include "server/upstream/upstream.hpp"

#include "client/headless/tls_trust.hpp"

namespace stipple::server {

Result<std::shared_ptr<Upstream>> Upstream::open(const UpstreamOptions& options) {
    STIPPLE_TRY(trust, TlsTrust::load(options.caPath));
    return std::shared_ptr<Upstream>(new Upstream(options, trust));
}

std::vector<Measurement> Upstream::measurements() const {
    auto counter = [](const char* name, const char* help, const std::atomic<std::uint64_t>& value) {
        return Measurement{name, help, true, static_cast<double>(value.load())};
    };
    return {counter("stipple_upstream_requests_total", "Ranges asked of other servers", counts.requests),
            counter("stipple_upstream_bytes_total", "Bytes that came from other servers", counts.bytes),
            counter("stipple_upstream_failures_total", "Ranges that other servers did not answer",
                    counts.failures),
            counter("stipple_upstream_timeouts_total", "Of those, for lack of an answer in time",
                    counts.timeouts),
            counter("stipple_upstream_changes_total", "Clouds found replaced or removed at other servers",
                    counts.changes)};
}

} // namespace stipple::server
