#include "client/region/point_taker.hpp"
#include "shared/base/text.hpp"
#include "shared/select/corridor_attributes.hpp"
#include "shared/sinks/csv_sink.hpp"
#include "shared/sinks/las_sink.hpp"

#include <nlohmann/json.hpp>

#include <numeric>

namespace stipple {

namespace {

using nlohmann::json;

class FileTaker final : public PointTaker {
  public:
    FileTaker(Metadata metadata, std::vector<int> attributes, std::shared_ptr<Pieces> pieces)
        : metadata_(std::move(metadata)), attributes_(std::move(attributes)), pieces_(std::move(pieces)) {}

    Status open(const std::string& format, const BoxI& reach) {
        SinkInput input{*metadata_, attributes_};
        auto to = std::make_unique<PieceSink>(pieces_);
        if (format == "csv") {
            STIPPLE_TRY(sink, csvSink(std::move(to), input));
            sink_ = std::move(sink);
            return {};
        }
        STIPPLE_TRY(plan, LasPlan::make(input, reach, metadata_->pointCount, format == "laz"));
        STIPPLE_TRY(sink, LasSink::create(std::move(to), plan, std::nullopt));
        warnings_ = sink->warnings();
        sink_ = std::move(sink);
        return {};
    }

    Status take(PointBatch batch) override {
        points_ += batch.size();
        STIPPLE_TRY(encoded, sink_->encode(std::move(batch)));
        return sink_->write(std::move(encoded));
    }

    Result<json> finish() override {
        STIPPLE_CHECK(sink_->finish());
        return json{
            {"points", points_}, {"bytes", pieces_->offset + pieces_->fresh.size()}, {"warnings", warnings_}};
    }

    const std::vector<int>& attributes() const override { return attributes_; }

  private:
    Metadata metadata_;
    std::vector<int> attributes_;
    std::shared_ptr<Pieces> pieces_;
    std::unique_ptr<PointSink> sink_;
    std::vector<std::string> warnings_;
    std::uint64_t points_ = 0;
};

Result<std::vector<int>> attributesFrom(const Schema& schema, const json& request) {
    std::vector<int> attributes(schema.attributes.size());
    std::iota(attributes.begin(), attributes.end(), 0);
    auto names = request.find("attributes");
    if (names == request.end() || names->is_null())
        return attributes;
    Error wrong{ErrorCode::invalidArgument, say("'attributes' must be a list of names"), "region", ""};
    if (!names->is_array())
        return wrong;
    attributes.clear();
    for (const json& name : *names) {
        if (!name.is_string())
            return wrong;
        STIPPLE_TRY(index, findAttribute(schema, name.get<std::string>()));
        attributes.push_back(index);
    }
    return attributes;
}

} // namespace

Result<std::unique_ptr<PointTaker>> fileTaker(const Metadata& metadata, const CloudFilter& filter,
                                              const json& request, std::shared_ptr<Pieces> pieces) {
    std::string format = textField(request, "format");
    if (format != "las" && format != "laz" && format != "csv")
        return Error{ErrorCode::invalidArgument, say("'format' must be las, laz or csv"), "region", ""};
    STIPPLE_TRY(attributes, attributesFrom(metadata->schema, request));
    Metadata written = metadata;
    if (filter.hasCorridor()) {
        auto extended = std::make_shared<CloudMetadata>(*metadata);
        addCorridorAttributes(*extended);
        auto stored = static_cast<int>(metadata->schema.attributes.size());
        attributes.insert(attributes.end(), {stored, stored + 1});
        written = std::move(extended);
    }
    auto taker = std::make_unique<FileTaker>(std::move(written), std::move(attributes), std::move(pieces));
    STIPPLE_CHECK(taker->open(format, filter.reach()));
    return std::unique_ptr<PointTaker>(std::move(taker));
}

} // namespace stipple
