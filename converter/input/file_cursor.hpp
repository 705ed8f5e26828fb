// A place in a file that moves forward: bytes are looked at, then passed. Holds a block of the file, or as
// much as was asked for at once.
#pragma once

#include "converter/input/shared_source.hpp"

namespace stipple {

class FileCursor {
  public:
    explicit FileCursor(SharedSource& source, std::uint64_t offset = 0, std::size_t blockBytes = 1 << 20)
        : source_(source), offset_(offset), blockBytes_(blockBytes) {}

    // The bytes from here on: at least `count`, fewer only where the file ends, and whatever else is held.
    // Borrowed until the next call.
    Result<ByteSpan> peek(std::size_t count);
    // Passes `count` bytes, held or not.
    void skip(std::uint64_t count);
    // The line from here on without its end ("\n", "\r\n" or "\r"), which is passed as well; at most
    // `mostBytes` long, else an error.
    Result<std::string> line(std::size_t mostBytes);

    std::uint64_t offset() const { return offset_; } // of the next byte
    bool atEnd() const { return offset_ >= source_.sizeBytes(); }

  private:
    SharedSource& source_;
    std::uint64_t offset_;
    std::size_t blockBytes_; // read at once, at least
    Bytes block_;
    std::size_t at_ = 0; // in block_
};

} // namespace stipple
