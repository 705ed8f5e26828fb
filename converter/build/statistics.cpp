#include "converter/build/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

namespace stipple {

namespace {
constexpr std::size_t maxHistogramValues = 256;

bool isInteger(AttributeType type) {
    return type != AttributeType::f32 && type != AttributeType::f64;
}

template <class T>
void countBytes(const Bytes& column, std::map<std::int64_t, std::uint64_t>& histogram) {
    std::array<std::uint64_t, 256> counts{};
    for (std::uint8_t byte : column)
        ++counts[byte];
    for (std::size_t byte = 0; byte < 256; ++byte)
        if (counts[byte] > 0)
            histogram[static_cast<T>(byte)] = counts[byte];
}

// False if there are too many values.
template <class T>
bool countValues(const Bytes& column, std::size_t values, std::map<std::int64_t, std::uint64_t>& histogram) {
    auto last = histogram.end();
    for (std::size_t i = 0; i < values; ++i) {
        auto value = static_cast<std::int64_t>(loadLe<T>(column.data() + i * sizeof(T)));
        if (last == histogram.end() || last->first != value)
            last = histogram.try_emplace(value, 0).first; // runs of one value cost no search
        ++last->second;
        if (histogram.size() > maxHistogramValues)
            return false;
    }
    return true;
}

template <class T>
PartialStatistics ofColumn(const Attribute& attribute, const Bytes& column) {
    PartialStatistics result;
    std::size_t values = column.size() / sizeof(T);
    T low{}, high{};
    double sum = 0;
    for (std::size_t i = 0; i < values; ++i) {
        T value = loadLe<T>(column.data() + i * sizeof(T));
        if constexpr (std::is_floating_point_v<T>)
            if (std::isnan(value))
                continue;
        low = result.count == 0 ? value : std::min(low, value);
        high = result.count == 0 ? value : std::max(high, value);
        sum += static_cast<double>(value);
        ++result.count;
    }
    result.min = static_cast<double>(low);
    result.max = static_cast<double>(high);
    if (result.count > 0)
        result.mean = sum / static_cast<double>(result.count);
    if (low != high)
        for (std::size_t i = 0; i < values; ++i) {
            double distance = static_cast<double>(loadLe<T>(column.data() + i * sizeof(T))) - result.mean;
            if (!std::isnan(distance))
                result.squares += distance * distance;
        }
    else if (result.count > 0)
        result.mean = result.min; // without the rounding of the sum
    if constexpr (std::is_integral_v<T>) {
        // A uint64 beyond the range of the histogram's values is not counted by value.
        bool fits = std::is_signed_v<T> || sizeof(T) < 8;
        if (attribute.components == 1 && fits) {
            result.histogram.emplace();
            if constexpr (sizeof(T) == 1)
                countBytes<T>(column, *result.histogram);
            else if (!countValues<T>(column, values, *result.histogram))
                result.histogram.reset();
        }
    }
    return result;
}

PartialStatistics ofAttribute(const Attribute& attribute, const Bytes& column) {
    switch (attribute.type) {
    case AttributeType::u8:
        return ofColumn<std::uint8_t>(attribute, column);
    case AttributeType::i8:
        return ofColumn<std::int8_t>(attribute, column);
    case AttributeType::u16:
        return ofColumn<std::uint16_t>(attribute, column);
    case AttributeType::i16:
        return ofColumn<std::int16_t>(attribute, column);
    case AttributeType::u32:
        return ofColumn<std::uint32_t>(attribute, column);
    case AttributeType::i32:
        return ofColumn<std::int32_t>(attribute, column);
    case AttributeType::u64:
        return ofColumn<std::uint64_t>(attribute, column);
    case AttributeType::i64:
        return ofColumn<std::int64_t>(attribute, column);
    case AttributeType::f32:
        return ofColumn<float>(attribute, column);
    case AttributeType::f64:
        return ofColumn<double>(attribute, column);
    }
    return {};
}
} // namespace

void PartialStatistics::merge(const PartialStatistics& other) {
    if (histogram && other.histogram) {
        for (const auto& [value, points] : *other.histogram)
            (*histogram)[value] += points;
        if (histogram->size() > maxHistogramValues)
            histogram.reset();
    } else {
        histogram.reset();
    }
    if (other.count == 0)
        return;
    if (count == 0) {
        min = other.min;
        max = other.max;
    }
    min = std::min(min, other.min);
    max = std::max(max, other.max);
    auto mine = static_cast<double>(count), theirs = static_cast<double>(other.count);
    double distance = other.mean - mean, all = mine + theirs;
    squares += other.squares + distance * distance * (mine / all) * theirs;
    mean += distance * (theirs / all);
    count += other.count;
}

AttributeStatistics PartialStatistics::finish() const {
    AttributeStatistics result;
    result.min = min;
    result.max = max;
    result.mean = mean;
    if (count > 0)
        result.deviation = std::sqrt(squares / static_cast<double>(count));
    if (histogram)
        result.histogram.assign(histogram->begin(), histogram->end());
    return result;
}

BatchStatistics emptyStatistics(const Schema& schema) {
    BatchStatistics result(schema.attributes.size());
    for (std::size_t a = 0; a < result.size(); ++a)
        if (isInteger(schema.attributes[a].type) && schema.attributes[a].components == 1)
            result[a].histogram.emplace();
    return result;
}

BatchStatistics statisticsOf(const Schema& schema, const PointBatch& batch) {
    BatchStatistics result;
    for (std::size_t a = 0; a < schema.attributes.size(); ++a)
        result.push_back(ofAttribute(schema.attributes[a], batch.columns[a]));
    return result;
}

void merge(BatchStatistics& into, const BatchStatistics& other) {
    for (std::size_t a = 0; a < into.size(); ++a)
        into[a].merge(other[a]);
}

} // namespace stipple
