// Bytes of clouds' files as they came: what was read over as the gap between two ranges that travelled
// together, and what decoded nodes were made of. What lies in them is not fetched again, also after the
// decoded node was dropped. Bounded in bytes; the least recently used go first.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/io/byte_source.hpp"

#include <cstdint>
#include <list>
#include <map>
#include <utility>

namespace stipple {

class KeptBytes {
  public:
    // Takes the place of parts that lie wholly in it; nothing happens if all of it is here.
    void add(std::uint32_t cloud, std::uint64_t offset, Bytes bytes);
    // How many bytes from range.offset on are here, at most range.size; they may lie in several parts.
    std::uint64_t headBytes(std::uint32_t cloud, ByteRange range) const;
    // Appends the bytes of `range`, all of which are here; they are used with it.
    void append(std::uint32_t cloud, ByteRange range, Bytes& to);
    // Drops the least recently used until at most so many bytes are held.
    void limit(std::uint64_t bytes);
    // Forgets every part that has bytes of the range: they are damaged.
    void erase(std::uint32_t cloud, ByteRange range);
    void eraseCloud(std::uint32_t cloud);
    std::uint64_t sizeBytes() const { return bytes_; }

  private:
    using Key = std::pair<std::uint32_t, std::uint64_t>; // cloud, offset
    struct Part {
        Bytes bytes;
        std::list<Key>::iterator use;
    };
    using Parts = std::map<Key, Part>;
    // The part that holds the byte at `offset`; end() if none does.
    Parts::const_iterator partAt(std::uint32_t cloud, std::uint64_t offset) const;
    Parts::iterator drop(Parts::const_iterator part);
    void touch(const Part& part) { uses_.splice(uses_.begin(), uses_, part.use); }

    Parts parts_;
    std::list<Key> uses_; // most recent first
    std::uint64_t bytes_ = 0;
};

} // namespace stipple
