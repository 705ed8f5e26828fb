// A byte source over HTTP that keeps what it fetched in a folder (range_store.hpp), and reads it from there
// when it is opened the next time. The first read always goes to the server, which tells the version; what is
// here of that version is not fetched again.
#pragma once

#include "client/headless/http_source.hpp"
#include "client/headless/range_store.hpp"

#include <memory>
#include <string>

namespace stipple {

struct StoredSourceCounts {
    std::uint64_t bytesFromDisk = 0;
    std::uint64_t readsFromDisk = 0; // answered without the server
};

// Errors: those of openHttpSource. `counts` (may be null) is kept up to date.
Result<std::unique_ptr<ByteSource>> openStoredSource(const std::string& url,
                                                     std::shared_ptr<RangeStore> store,
                                                     std::shared_ptr<StoredSourceCounts> counts,
                                                     HttpSourceOptions options = {});

} // namespace stipple
