// Bytes in little-endian order: load, store, and bounded cursors.
//
// ByteReader never reads past its span: once a read would, it returns zero, `ok()` turns false and stays
// false. Check it once after a group of reads.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace stipple {

using Bytes = std::vector<std::uint8_t>;
using ByteSpan = std::span<const std::uint8_t>;

static_assert(std::endian::native == std::endian::little, "the file format is read by plain copies");

template <class T>
T loadLe(const std::uint8_t* from) {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

template <class T>
void storeLe(std::uint8_t* to, T value) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::memcpy(to, &value, sizeof value);
}

// The same bits as another type of that size (std::bit_cast, which the WebAssembly library does not have).
template <class To, class From>
To bitCast(const From& from) {
    static_assert(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<From>);
    To to;
    std::memcpy(&to, &from, sizeof to);
    return to;
}

class ByteReader {
  public:
    explicit ByteReader(ByteSpan bytes) : bytes_(bytes) {}

    template <class T>
    T read() {
        if (remaining() < sizeof(T)) {
            fail();
            return T{};
        }
        T value = loadLe<T>(bytes_.data() + at_);
        at_ += sizeof(T);
        return value;
    }

    // The next `size` bytes, borrowed; empty once the reader has failed.
    ByteSpan readBytes(std::size_t size) {
        if (remaining() < size) {
            fail();
            return {};
        }
        ByteSpan part = bytes_.subspan(at_, size);
        at_ += size;
        return part;
    }

    // A text field of fixed width, cut at its first NUL.
    std::string readFixedText(std::size_t width) {
        ByteSpan part = readBytes(width);
        std::size_t length = 0;
        while (length < part.size() && part[length] != 0)
            ++length;
        return std::string(reinterpret_cast<const char*>(part.data()), length);
    }

    void skip(std::size_t size) { (void)readBytes(size); }
    bool ok() const { return !failed_; }
    std::size_t position() const { return at_; }
    std::size_t remaining() const { return failed_ ? 0 : bytes_.size() - at_; }

  private:
    void fail() { failed_ = true; }
    ByteSpan bytes_;
    std::size_t at_ = 0;
    bool failed_ = false;
};

class ByteWriter {
  public:
    template <class T>
    void write(T value) {
        std::size_t at = bytes_.size();
        bytes_.resize(at + sizeof(T));
        storeLe(bytes_.data() + at, value);
    }

    void writeBytes(ByteSpan part) { bytes_.insert(bytes_.end(), part.begin(), part.end()); }

    // Text in a field of fixed width: cut to it, or padded with NULs.
    void writeFixedText(std::string_view text, std::size_t width) {
        for (std::size_t i = 0; i < width; ++i)
            bytes_.push_back(i < text.size() ? static_cast<std::uint8_t>(text[i]) : std::uint8_t{0});
    }

    std::size_t size() const { return bytes_.size(); }
    Bytes& bytes() { return bytes_; }
    Bytes take() { return std::move(bytes_); }

  private:
    Bytes bytes_;
};

} // namespace stipple
