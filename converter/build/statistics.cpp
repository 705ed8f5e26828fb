#include "converter/build/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace stipple {

namespace {
constexpr std::size_t maxHistogramValues = 256;

bool isInteger(AttributeType type) {
    return type != AttributeType::f32 && type != AttributeType::f64;
}

// Counts each value in [low, low + counts): false if there are too many different ones.
template <class T>
bool countInTable(const Bytes& column, std::size_t values, T low, std::size_t range,
                  std::map<std::int64_t, std::uint64_t>& histogram) {
    std::vector<std::uint32_t> counts(range, 0);
    for (std::size_t i = 0; i < values; ++i)
        ++counts[static_cast<std::size_t>(
            static_cast<std::int64_t>(loadLe<T>(column.data() + i * sizeof(T))) -
            static_cast<std::int64_t>(low))];
    for (std::size_t v = 0; v < range; ++v) {
        if (counts[v] > 0)
            histogram[static_cast<std::int64_t>(low) + static_cast<std::int64_t>(v)] = counts[v];
        if (histogram.size() > maxHistogramValues)
            return false;
    }
    return true;
}

// The same for values that lie far apart.
template <class T>
bool countInMap(const Bytes& column, std::size_t values, std::map<std::int64_t, std::uint64_t>& histogram) {
    for (std::size_t i = 0; i < values; ++i) {
        ++histogram[static_cast<std::int64_t>(loadLe<T>(column.data() + i * sizeof(T)))];
        if (histogram.size() > maxHistogramValues)
            return false;
    }
    return true;
}

template <class T>
bool countValues(const Bytes& column, std::size_t values, T low, T high,
                 std::map<std::int64_t, std::uint64_t>& histogram) {
    constexpr std::uint64_t maxTable = 65536;
    std::uint64_t range = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low);
    if (range < maxTable)
        return countInTable<T>(column, values, low, static_cast<std::size_t>(range) + 1, histogram);
    return countInMap<T>(column, values, histogram);
}

// Mean and squares of values of at most 16 bits, from exact sums, which also vectorize.
template <class T>
void sumSmall(const Bytes& column, std::size_t values, PartialStatistics& result) {
    std::int64_t sum = 0;
    std::uint64_t squares = 0;
    for (std::size_t i = 0; i < values; ++i) {
        std::int32_t value = loadLe<T>(column.data() + i * sizeof(T));
        sum += value;
        squares += static_cast<std::uint64_t>(static_cast<std::int64_t>(value) * value);
    }
    auto count = static_cast<double>(values);
    auto rest =
        static_cast<__int128>(squares) * static_cast<__int128>(values) - static_cast<__int128>(sum) * sum;
    result.mean = static_cast<double>(sum) / count;
    result.squares = static_cast<double>(rest) / count;
}

template <class T>
void sumWide(const Bytes& column, std::size_t values, PartialStatistics& result) {
    double sum = 0;
    for (std::size_t i = 0; i < values; ++i) {
        auto value = static_cast<double>(loadLe<T>(column.data() + i * sizeof(T)));
        sum += std::isnan(value) ? 0 : value;
    }
    result.mean = sum / static_cast<double>(result.count);
    for (std::size_t i = 0; i < values; ++i) {
        double distance = static_cast<double>(loadLe<T>(column.data() + i * sizeof(T))) - result.mean;
        result.squares += std::isnan(distance) ? 0 : distance * distance;
    }
}

// All values are the first one: many attributes of many scans are not used.
template <class T>
bool isConstant(const Bytes& column) {
    return column.size() > sizeof(T) &&
           std::memcmp(column.data(), column.data() + sizeof(T), column.size() - sizeof(T)) == 0;
}

template <class T>
PartialStatistics ofColumn(const Attribute& attribute, const Bytes& column) {
    if (isConstant<T>(column)) {
        Bytes first(column.begin(), column.begin() + sizeof(T));
        PartialStatistics one = ofColumn<T>(attribute, first);
        one.count *= column.size() / sizeof(T);
        if (one.histogram)
            for (auto& [value, points] : *one.histogram)
                points *= column.size() / sizeof(T);
        return one;
    }
    PartialStatistics result;
    std::size_t values = column.size() / sizeof(T);
    T low{}, high{};
    if constexpr (std::is_integral_v<T>) {
        result.count = values;
        if (values > 0)
            low = high = loadLe<T>(column.data());
        for (std::size_t i = 0; i < values; ++i) {
            T value = loadLe<T>(column.data() + i * sizeof(T));
            low = std::min(low, value);
            high = std::max(high, value);
        }
    } else {
        for (std::size_t i = 0; i < values; ++i) {
            T value = loadLe<T>(column.data() + i * sizeof(T));
            if (std::isnan(value))
                continue;
            low = result.count == 0 ? value : std::min(low, value);
            high = result.count == 0 ? value : std::max(high, value);
            ++result.count;
        }
    }
    result.min = static_cast<double>(low);
    result.max = static_cast<double>(high);
    if (low == high)
        result.mean = result.min; // without the rounding of a sum
    else if constexpr (sizeof(T) <= 2)
        sumSmall<T>(column, values, result);
    else
        sumWide<T>(column, values, result);
    if constexpr (std::is_integral_v<T>) {
        // A uint64 may be beyond the range of the histogram's values.
        bool fits = std::is_signed_v<T> || sizeof(T) < 8;
        if (attribute.components == 1 && fits) {
            result.histogram.emplace();
            if (values > 0 && !countValues<T>(column, values, low, high, *result.histogram))
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
