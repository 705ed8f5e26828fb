// One word for both directions: code…(coder, …, value) writes `value` and returns it, or reads and returns
// what was written (then `value` is not looked at). An item that is written in these words is compressed and
// decompressed by one function.
//
// Coders are passed and returned by value: two words, so their state stays in registers across calls.
#pragma once

#include "shared/las/laz/integer_compressor.hpp"

#include <type_traits>

namespace stipple::las::laz {

template <class Coder>
inline constexpr bool encodes = std::is_same_v<Coder, ArithmeticEncoder>;

template <class Model>
STIPPLE_LAZ_INLINE unsigned codeSymbol(ArithmeticDecoder& from, Model& model, unsigned) {
    return from.decodeSymbol(model);
}
template <class Model>
STIPPLE_LAZ_INLINE unsigned codeSymbol(ArithmeticEncoder& to, Model& model, unsigned value) {
    to.encodeSymbol(model, value);
    return value;
}

// A byte, as its difference to `predicted` (both modulo 256).
template <class Coder, class Model>
STIPPLE_LAZ_INLINE std::uint8_t codeByte(Coder& coder, Model& model, unsigned predicted, unsigned value) {
    return static_cast<std::uint8_t>(predicted + codeSymbol(coder, model, (value - predicted) & 0xFF));
}

template <class Compressor>
STIPPLE_LAZ_INLINE std::int32_t codeInteger(ArithmeticDecoder& from, Compressor& compressor,
                                            std::int32_t predicted, std::int32_t, unsigned context = 0) {
    return compressor.decompress(from, predicted, context);
}
template <class Compressor>
STIPPLE_LAZ_INLINE std::int32_t codeInteger(ArithmeticEncoder& to, Compressor& compressor,
                                            std::int32_t predicted, std::int32_t value,
                                            unsigned context = 0) {
    compressor.compress(to, predicted, value, context);
    return value;
}

// Sums and differences wrap, as the format's do on every machine it was written on.
STIPPLE_LAZ_INLINE std::int32_t wrapAdd(std::int32_t a, std::int32_t b) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}
STIPPLE_LAZ_INLINE std::int32_t wrapSubtract(std::int32_t a, std::int32_t b) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}
STIPPLE_LAZ_INLINE std::int32_t wrapMultiply(std::int32_t a, std::int32_t b) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) * static_cast<std::uint32_t>(b));
}

} // namespace stipple::las::laz
