// The item BYTE: extra bytes of formats 0-5, each by itself, versions 1 and 2.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/las/laz/coding.hpp"

namespace stipple::las::laz {

class BytesV2 {
  public:
    static constexpr std::size_t maxBytesEach = 2;

    explicit BytesV2(std::size_t count) : last_(count), models_(count) {}

    void start(const std::uint8_t* first) {
        std::copy_n(first, last_.size(), last_.begin());
        for (auto& model : models_)
            model.init();
    }

    template <class Coder, class Byte>
    Coder code(Coder coder, Byte* record) {
        for (std::size_t i = 0; i < last_.size(); ++i) {
            last_[i] = codeByte(coder, models_[i], last_[i], encodes<Coder> ? record[i] : 0u);
            if constexpr (!encodes<Coder>)
                record[i] = last_[i];
        }
        return coder;
    }

  private:
    Bytes last_;
    std::vector<SymbolModel<256>> models_;
};

// Version 1 (LASzip 1.x): corrections of any of the bytes share their models of places.
class BytesV1 {
  public:
    static constexpr std::size_t maxBytesEach = 8;

    explicit BytesV1(std::size_t count) : last_(count), sizes_(count) {}

    void start(const std::uint8_t* first) {
        std::copy_n(first, last_.size(), last_.begin());
        for (auto& model : sizes_)
            model.init();
        values_.init();
    }

    template <class Coder, class Byte>
    Coder code(Coder coder, Byte* record) {
        for (std::size_t i = 0; i < last_.size(); ++i) {
            if constexpr (encodes<Coder>)
                values_.compressBy(sizes_[i], coder, last_[i], record[i]);
            else
                record[i] = static_cast<std::uint8_t>(values_.decompressBy(sizes_[i], coder, last_[i]));
            last_[i] = record[i];
        }
        return coder;
    }

  private:
    Bytes last_;
    std::vector<SymbolModel<9>> sizes_;
    IntegerCompressor<8, 0> values_;
};

} // namespace stipple::las::laz
