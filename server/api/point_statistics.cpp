#include "server/api/point_statistics.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::server {

namespace {

constexpr std::size_t axes = 3;

// Calls each(value) for the values of a column, as double.
template <class T, class Each>
void forValues(const Bytes& column, const Each& each) {
    for (std::size_t at = 0; at + sizeof(T) <= column.size(); at += sizeof(T))
        each(static_cast<double>(loadLe<T>(column.data() + at)));
}

template <class Each>
void forEachValue(AttributeType type, const Bytes& column, const Each& each) {
    switch (type) {
    case AttributeType::u8:
        return forValues<std::uint8_t>(column, each);
    case AttributeType::i8:
        return forValues<std::int8_t>(column, each);
    case AttributeType::u16:
        return forValues<std::uint16_t>(column, each);
    case AttributeType::i16:
        return forValues<std::int16_t>(column, each);
    case AttributeType::u32:
        return forValues<std::uint32_t>(column, each);
    case AttributeType::i32:
        return forValues<std::int32_t>(column, each);
    case AttributeType::u64:
        return forValues<std::uint64_t>(column, each);
    case AttributeType::i64:
        return forValues<std::int64_t>(column, each);
    case AttributeType::f32:
        return forValues<float>(column, each);
    case AttributeType::f64:
        return forValues<double>(column, each);
    }
}

Bytes withoutNoData(const Attribute& attribute, const Bytes& column) {
    std::size_t size = attributeTypeSize(attribute.type), at = 0;
    Bytes kept;
    kept.reserve(column.size());
    forEachValue(attribute.type, column, [&](double value) {
        if (value != *attribute.noData)
            kept.insert(kept.end(), column.begin() + static_cast<std::ptrdiff_t>(at),
                        column.begin() + static_cast<std::ptrdiff_t>(at + size));
        at += size;
    });
    return kept;
}

Bytes coordinates(const std::vector<Vec3i>& positions, int axis) {
    Bytes column(positions.size() * sizeof(std::int64_t));
    for (std::size_t i = 0; i < positions.size(); ++i)
        storeLe<std::int64_t>(column.data() + i * sizeof(std::int64_t), positions[i][axis]);
    return column;
}

std::vector<double> edgesOf(double low, double high, std::size_t bins) {
    if (bins == 0 || !std::isfinite(low) || !std::isfinite(high) || !std::isfinite(high - low))
        return {};
    if (low == high)
        return {low, high};
    std::vector<double> edges;
    for (std::size_t i = 0; i < bins; ++i)
        edges.push_back(low + (high - low) * (static_cast<double>(i) / static_cast<double>(bins)));
    edges.push_back(high);
    return edges;
}

void setEdges(StatisticsColumn& column, double low, double high, std::size_t bins) {
    double first = column.meaningOf(low), last = column.meaningOf(high);
    column.edges = edgesOf(std::min(first, last), std::max(first, last), bins);
}

} // namespace

std::optional<std::size_t> intervalOf(const std::vector<double>& edges, double value) {
    if (edges.size() < 2 || !(value >= edges.front() && value <= edges.back()))
        return std::nullopt;
    if (edges.front() == edges.back())
        return 0;
    std::size_t last = edges.size() - 2;
    double width = edges.back() - edges.front();
    auto guess = static_cast<std::size_t>((value - edges.front()) / width * static_cast<double>(last + 1));
    std::size_t i = std::min(guess, last); // right but for rounding
    while (i > 0 && value < edges[i])
        --i;
    while (i < last && value >= edges[i + 1])
        ++i;
    return i;
}

std::vector<StatisticsColumn> statisticsColumns(const SinkInput& input, const BoxI& reach, std::size_t bins) {
    std::vector<StatisticsColumn> columns;
    const Grid& grid = input.metadata.grid;
    for (int axis = 0; axis < static_cast<int>(axes); ++axis) {
        Attribute attribute{std::string(1, "XYZ"[axis]), AttributeType::i64};
        attribute.scale = grid.scale[axis];
        attribute.offset = grid.offset[axis];
        columns.push_back({attribute, {}});
        if (!reach.empty())
            setEdges(columns.back(), static_cast<double>(reach.min[axis]),
                     static_cast<double>(reach.max[axis]), bins);
    }
    for (int index : input.attributes) {
        columns.push_back({input.metadata.schema.attributes[static_cast<std::size_t>(index)], {}});
        const AttributeStatistics& stored = input.metadata.statistics[static_cast<std::size_t>(index)];
        setEdges(columns.back(), stored.min, stored.max, bins);
    }
    return columns;
}

StatisticsSink::StatisticsSink(std::vector<StatisticsColumn> columns)
    : columns_(std::move(columns)), all_(columns_.size()) {
    for (const StatisticsColumn& column : columns_)
        schema_.attributes.push_back(column.attribute);
    BatchStatistics empty = emptyStatistics(schema_);
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        all_[c].stored = std::move(empty[c]);
        all_[c].counts.resize(columns_[c].edges.empty() ? 0 : columns_[c].edges.size() - 1);
    }
}

StatisticsSink::Part StatisticsSink::statisticsOf(const PointBatch& batch) const {
    PointBatch values;
    for (int axis = 0; axis < static_cast<int>(axes); ++axis)
        values.columns.push_back(coordinates(batch.positions, axis));
    for (std::size_t a = 0; a < batch.columns.size(); ++a) {
        const Attribute& attribute = columns_[axes + a].attribute;
        values.columns.push_back(attribute.noData ? withoutNoData(attribute, batch.columns[a])
                                                  : batch.columns[a]);
    }
    BatchStatistics stored = stipple::statisticsOf(schema_, values);
    Part part(columns_.size());
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        const StatisticsColumn& column = columns_[c];
        part[c].stored = std::move(stored[c]);
        if (column.edges.empty())
            continue;
        part[c].counts.resize(column.edges.size() - 1);
        forEachValue(column.attribute.type, values.columns[c], [&](double value) {
            if (auto interval = intervalOf(column.edges, column.meaningOf(value)))
                ++part[c].counts[*interval];
        });
    }
    return part;
}

Result<EncodedPoints> StatisticsSink::encode(PointBatch batch) const {
    EncodedPoints points;
    points.count = batch.size();
    Part part = statisticsOf(batch);
    std::lock_guard lock(mutex_);
    points.bytes.resize(sizeof nextPart_);
    storeLe(points.bytes.data(), nextPart_);
    parts_.emplace(nextPart_++, std::move(part));
    return points;
}

Status StatisticsSink::write(EncodedPoints points) {
    std::unique_lock lock(mutex_);
    auto waiting = parts_.extract(loadLe<std::uint64_t>(points.bytes.data()));
    lock.unlock();
    const Part& part = waiting.mapped();
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        all_[c].stored.merge(part[c].stored);
        for (std::size_t i = 0; i < all_[c].counts.size(); ++i)
            all_[c].counts[i] += part[c].counts[i];
    }
    return {};
}

} // namespace stipple::server
