#include "client/region/region_work.hpp"

#include "shared/base/text.hpp"
#include "shared/select/region_json.hpp"

namespace stipple {

namespace {

using nlohmann::json;

Result<std::unique_ptr<PointTaker>> takerFor(const std::string& make, const Metadata& metadata,
                                             const CloudFilter& filter, const json& request,
                                             const std::shared_ptr<Pieces>& pieces) {
    if (make == "file")
        return fileTaker(metadata, filter, request, pieces);
    if (make == "count")
        return countTaker();
    return make == "profile" ? profileTaker(metadata, filter, pieces) : volumeTaker(metadata, request);
}

} // namespace

std::string textField(const json& request, const char* name) {
    if (!request.is_object())
        return "";
    auto field = request.find(name);
    return field != request.end() && field->is_string() ? field->get<std::string>() : "";
}

Result<std::unique_ptr<RegionWork>> RegionWork::make(std::shared_ptr<const CloudMetadata> metadata,
                                                     const json& request) {
    std::unique_ptr<RegionWork> work(new RegionWork());
    work->metadata_ = std::move(metadata);
    std::string make = textField(request, "make");
    if (make != "file" && make != "profile" && make != "volume" && make != "count")
        return Error{ErrorCode::invalidArgument, say("'make' must be file, profile, volume or count"),
                     "region", ""};
    json region = request.contains("region") ? request["region"] : json::object();
    if (make == "volume") {
        STIPPLE_TRY(column, volumeRegion(request));
        region = std::move(column);
    }
    STIPPLE_TRY(stated, regionFromJson(region, "region"));
    STIPPLE_TRY(filter, CloudFilter::make(*work->metadata_, stated));
    work->filter_ = std::make_unique<CloudFilter>(std::move(filter));
    STIPPLE_TRY(taker, takerFor(make, work->metadata_, *work->filter_, request, work->pieces_));
    work->taker_ = std::move(taker);
    STIPPLE_TRY(chooser, PointChooser::make(*work->metadata_, *work->filter_, work->taker_->attributes()));
    work->chooser_ = std::make_unique<PointChooser>(std::move(chooser));
    if (auto most = request.find("mostPoints"); most != request.end()) {
        if (!most->is_number_unsigned())
            return Error{ErrorCode::invalidArgument, say("'mostPoints' must be a whole number"), "region",
                         ""};
        work->mostPoints_ = most->get<std::uint64_t>();
    }
    work->scan_ = {{"region", std::move(region)}, {"attributes", work->taker_->attributes()}};
    return work;
}

Status RegionWork::take(NodeBytes node, bool tested) {
    node.attributes = attributesToRead(tested);
    CloudFilter::Dropped dropped;
    STIPPLE_TRY(batch, chooser_->choose(node, tested, dropped));
    points_ += batch.size();
    if (mostPoints_ > 0 && points_ > mostPoints_)
        return Error{ErrorCode::limitExceeded, say("the region holds more than ", mostPoints_, " points"), "",
                     say("choose a smaller one, or use stipple export")};
    return taker_->take(std::move(batch));
}

Result<json> RegionWork::finish() {
    STIPPLE_TRY(answer, taker_->finish());
    answer["points"] = points_;
    return answer;
}

} // namespace stipple
