// LZF, the compression of PCD files (M. Lehmann's LibLZF), decoded from any noted place on.
//
// The stream is tokens:  000LLLLL                     L + 1 bytes follow as they are
//                        LLLooooo oooooooo            L + 2 bytes (L = 1 … 6) again from o + 1 bytes back
//                        111ooooo NNNNNNNN oooooooo   N + 9 bytes again from o + 1 bytes back
//
// so what is decoded depends on the 8192 bytes before it, and a decoder can be put down and taken up with
// those.
#pragma once

#include "converter/input/file_cursor.hpp"

#include <array>

namespace stipple {

inline constexpr std::size_t lzfWindowBytes = 8192;

// Where a decoder was.
struct LzfPlace {
    std::uint64_t fileOffset = 0;   // of the next token
    std::uint64_t outputOffset = 0; // of its first byte
    Bytes window;                   // the last bytes decoded before it, at most lzfWindowBytes
};

class LzfDecoder {
  public:
    // `fileEnd` ends the compressed bytes, `outputEnd` the decoded ones.
    LzfDecoder(SharedSource& source, const LzfPlace& place, std::uint64_t fileEnd, std::uint64_t outputEnd);

    // Decodes the next `count` bytes of output to `to`, or passes them where `to` is null. Errors: the stream
    // ends early (`truncated`), or is damaged (`corrupt`).
    Status read(std::uint8_t* to, std::uint64_t count);
    // From which everything from `outputOffset()` on can be decoded; begins at a token, so up to 264 bytes
    // before.
    LzfPlace place() const;
    std::uint64_t outputOffset() const { return given_; } // of the next byte that read() gives

  private:
    Status decodeToken();
    Error damaged(const char* what) const;

    // Decoded bytes: buffer_[0 … decoded_). The oldest are thrown away when it is full, but for a window.
    static constexpr std::size_t bufferBytes = 8 * lzfWindowBytes, mostTokenBytes = 264;

    FileCursor cursor_;
    std::uint64_t fileEnd_, outputEnd_;
    std::string name_;
    Bytes buffer_;
    std::size_t decoded_ = 0, tokenBegin_ = 0; // tokenBegin_: of the last token, in buffer_
    std::uint64_t bufferOutput_ = 0;           // output offset of buffer_[0]
    std::uint64_t tokenFileOffset_ = 0;
    std::uint64_t given_ = 0; // output offset up to which read() has given bytes
};

} // namespace stipple
