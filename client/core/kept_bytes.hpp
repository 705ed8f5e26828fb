// Bytes of clouds' files that came along, read over as the gap between two ranges that travelled together.
// They are kept as they are, so that what lies in them is not fetched again. Bounded in bytes; the oldest go
// first.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/io/byte_source.hpp"

#include <cstdint>
#include <deque>
#include <map>
#include <utility>

namespace stipple {

class KeptBytes {
  public:
    // Parts do not overlap: what came is not asked for again while it is here.
    void add(std::uint32_t cloud, std::uint64_t offset, Bytes bytes);
    // How many bytes from range.offset on are here, at most range.size; they may lie in several parts.
    std::uint64_t headBytes(std::uint32_t cloud, ByteRange range) const;
    // Appends the bytes of `range`, all of which are here.
    void append(std::uint32_t cloud, ByteRange range, Bytes& to) const;
    // Drops the oldest until at most so many bytes are held.
    void limit(std::uint64_t bytes);
    void eraseCloud(std::uint32_t cloud);
    std::uint64_t sizeBytes() const { return bytes_; }

  private:
    using Key = std::pair<std::uint32_t, std::uint64_t>; // cloud, offset
    using Parts = std::map<Key, Bytes>;
    // The part that holds the byte at `offset`; end() if none does.
    Parts::const_iterator partAt(std::uint32_t cloud, std::uint64_t offset) const;

    Parts parts_;
    std::deque<Key> ages_; // oldest first; may name parts that are gone
    std::uint64_t bytes_ = 0;
};

} // namespace stipple
