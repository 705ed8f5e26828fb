// The values of a column, whatever type they have.
#pragma once

#include "converter/input/table.hpp"

#include <cmath>
#include <limits>
#include <type_traits>

namespace stipple {

// Calls `use` with a zero of the type.
template <class Use>
void visitType(AttributeType type, const Use& use) {
    switch (type) {
    case AttributeType::u8:
        return use(std::uint8_t{});
    case AttributeType::i8:
        return use(std::int8_t{});
    case AttributeType::u16:
        return use(std::uint16_t{});
    case AttributeType::i16:
        return use(std::int16_t{});
    case AttributeType::u32:
        return use(std::uint32_t{});
    case AttributeType::i32:
        return use(std::int32_t{});
    case AttributeType::u64:
        return use(std::uint64_t{});
    case AttributeType::i64:
        return use(std::int64_t{});
    case AttributeType::f32:
        return use(float{});
    case AttributeType::f64:
        return use(double{});
    }
}

// Calls `use` with a zero of what rows hold: a type, or Number.
template <class Use>
void visitRows(const TableField& field, const Use& use) {
    if (field.isText)
        use(Number{});
    else
        visitType(*field.type, use);
}

// The value as a double: the nearest, where none is the same.
template <class From>
double asDouble(const From& from) {
    if constexpr (std::is_same_v<From, Number>)
        return toDouble(from);
    else
        return static_cast<double>(from);
}

// The same number as a T; one that does not fit becomes the nearest that does, NaN 0.
template <class T, class From>
T convertValue(const From& from) {
    using Limits = std::numeric_limits<T>;
    if constexpr (std::is_same_v<From, Number>) {
        if constexpr (std::is_same_v<T, float>) {
            return toFloat(from);
        } else if constexpr (std::is_same_v<T, double>) {
            return toDouble(from);
        } else {
            WholeNumber whole = toWhole(from);
            return whole.fits ? convertValue<T>(whole.value) : convertValue<T>(toDouble(from));
        }
    } else if constexpr (std::is_floating_point_v<T>) {
        return static_cast<T>(from);
    } else if constexpr (std::is_floating_point_v<From>) {
        if (!(from > static_cast<From>(Limits::lowest())))
            return from == from ? Limits::lowest() : T{0};
        return from >= static_cast<From>(Limits::max()) ? Limits::max() : static_cast<T>(from);
    } else {
        if (std::cmp_less(from, Limits::lowest()))
            return Limits::lowest();
        return std::cmp_greater(from, Limits::max()) ? Limits::max() : static_cast<T>(from);
    }
}

// The smallest and the largest integer of a type of integers.
struct IntegerLimits {
    std::int64_t min;
    std::uint64_t max;
};
inline IntegerLimits integerLimits(AttributeType type) {
    IntegerLimits limits{0, 0};
    visitType(type, [&](auto zero) {
        using T = decltype(zero);
        if constexpr (std::is_integral_v<T>)
            limits = {static_cast<std::int64_t>(std::numeric_limits<T>::lowest()),
                      static_cast<std::uint64_t>(std::numeric_limits<T>::max())};
    });
    return limits;
}
inline bool isInteger(AttributeType type) {
    return type != AttributeType::f32 && type != AttributeType::f64;
}

} // namespace stipple
