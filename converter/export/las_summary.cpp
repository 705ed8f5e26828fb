#include "converter/export/las_summary.hpp"

namespace stipple {

namespace {

// Takes the columns that a summary is made of, and nothing else.
class SummarySink final : public PointSink {
  public:
    SummarySink(const LasPlan& plan, const las::SummaryColumns& columns) : shift_(plan.shift) {
        own_.pointFormat = columns.pointFormat;
        auto take = [&](std::size_t column) {
            schema_.attributes.push_back(plan.options.schema.attributes[column]);
            columns_.push_back(column);
            return columns_.size() - 1;
        };
        if (columns.returnNumber >= 0)
            own_.returnNumber = static_cast<int>(take(static_cast<std::size_t>(columns.returnNumber)));
        for (std::size_t described : columns.described)
            own_.described.push_back(take(described));
        summary_.ranges.resize(own_.described.size());
    }

    // Of the plan's columns, those this takes.
    const std::vector<std::size_t>& columns() const { return columns_; }
    const las::PointSummary& summary() const { return summary_; }

    Result<EncodedPoints> encode(PointBatch batch) const override {
        EncodedPoints points;
        points.count = batch.size();
        points.batch = std::move(batch);
        return points;
    }
    Status write(EncodedPoints points) override {
        for (Vec3i& position : points.batch.positions)
            position = position - shift_;
        las::addToSummary(summary_, own_, schema_, points.batch);
        return {};
    }
    Status finish() override { return {}; }

  private:
    Vec3i shift_;
    Schema schema_;
    std::vector<std::size_t> columns_;
    las::SummaryColumns own_; // as columns of schema_
    las::PointSummary summary_;
};

// Nothing if the metadata do not know.
std::optional<las::PointSummary> summaryOfCloud(const CloudMetadata& metadata,
                                                const las::SummaryColumns& columns, int returnAttribute,
                                                Vec3i shift) {
    if (!columns.described.empty() || metadata.bounds.empty())
        return std::nullopt;
    las::PointSummary summary;
    summary.pointCount = metadata.pointCount;
    summary.bounds = {metadata.bounds.min - shift, metadata.bounds.max - shift};
    if (columns.returnNumber < 0)
        return summary;
    auto place = static_cast<std::size_t>(returnAttribute);
    if (place >= metadata.statistics.size() || metadata.statistics[place].histogram.empty())
        return std::nullopt;
    std::int64_t returns = columns.pointFormat >= 6 ? 15 : 5;
    for (const auto& [value, count] : metadata.statistics[place].histogram)
        if (value >= 1 && value <= returns)
            summary.pointsByReturn[static_cast<std::size_t>(value - 1)] = count;
    return summary;
}

} // namespace

Result<las::PointSummary> summarizeForLas(CloudReader& reader, const std::string& name,
                                          const CloudFilter& filter, const SinkInput& input,
                                          const LasPlan& plan, const WalkOptions& options) {
    STIPPLE_TRY(columns, las::summaryColumnsFor(plan.options));
    if (filter.wantsEverything() && options.limit == 0) {
        int returnAttribute =
            columns.returnNumber < 0 ? -1 : input.attributes[static_cast<std::size_t>(columns.returnNumber)];
        if (auto known = summaryOfCloud(input.metadata, columns, returnAttribute, plan.shift))
            return *known;
    }
    SummarySink sink(plan, columns);
    std::vector<int> attributes;
    for (std::size_t column : sink.columns())
        attributes.push_back(input.attributes[column]);
    STIPPLE_TRY(walked, walkPoints(reader, name, filter, attributes, sink, options));
    static_cast<void>(walked);
    return sink.summary();
}

} // namespace stipple
