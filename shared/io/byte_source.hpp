// Where bytes come from: a local file, an HTTP server, a browser's File, a buffer in a test. One call:
// "read these bytes of this version of the file".
//
// Thread: one thread owns a source, calls read() and pump(), and gets every completion on that thread,
// either inside read() or inside pump(). Every read is answered exactly once, also when it fails, is
// cancelled, or the source is destroyed (then with `cancelled`).
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace stipple {

struct ByteRange {
    std::uint64_t offset = 0; // first byte
    std::uint64_t size = 0;   // number of bytes; reading 0 bytes is answered at once with none

    std::uint64_t end() const { return offset + size; }
    friend bool operator==(const ByteRange&, const ByteRange&) = default;
};

class ByteSource {
  public:
    using Completion = std::function<void(Result<Bytes>)>;
    using RequestId = std::uint64_t;

    virtual ~ByteSource() = default;

    // Asks for `range`. The answer holds exactly the bytes asked for; a range that reaches past the end of
    // the file is cut there, and one that starts past it is `truncated`. If the file is no longer the
    // version first read, the answer is `changed`.
    virtual RequestId read(ByteRange range, Completion done) = 0;

    // Takes a request back; its completion is called with `cancelled` unless it was answered already.
    virtual void cancel(RequestId) {}

    // How far an open read is: whether its answer has begun, how many of its bytes are here, and, where the
    // source was there to see it, when it began. Sources that can't tell, and reads that were answered, say
    // nothing.
    struct Progress {
        bool hasBegun = false;
        std::uint64_t bytes = 0;
        std::optional<std::chrono::steady_clock::time_point> begunAt = {};
    };
    virtual Progress progress(RequestId) const { return {}; }

    // Whatever version of the file the next answer is of is the one to be read from now on. False: it is one
    // version for good. No read is open.
    virtual bool forgetVersion() { return false; }

    // What may go wrong with it later although it can be read: a sentence. Empty: nothing is known.
    virtual std::string caution() const { return {}; }

    // Whether a request may read over what nobody asked for, to save another one. Not where what was asked
    // for is at hand, and only the rest would have to be fetched.
    virtual bool readsOverGaps() const { return true; }

    // Delivers completions that have arrived, waiting up to `wait` for the first. Returns the number
    // delivered. Sources that answer inside read(), or that a browser drives, have nothing to do here.
    virtual int pump(std::chrono::milliseconds wait) {
        (void)wait;
        return 0;
    }

    // Size of the whole file in bytes, once known (after the first answer at the latest); else 0.
    virtual std::uint64_t sizeBytes() const = 0;

    // File name or address, for messages.
    virtual std::string name() const = 0;
};

// Reads `range` and waits for it (pumping); for programs that have nothing else to do.
Result<Bytes> readNow(ByteSource& source, ByteRange range);

} // namespace stipple
