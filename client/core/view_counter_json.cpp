#include "client/core/colour_json.hpp"
#include "client/core/json.hpp"
#include "client/core/view_counter.hpp"

namespace stipple {

namespace {

using json_fields::FieldReader;
using nlohmann::json;

Status readRequest(const json& item, const std::string& path, std::vector<HistogramRequest>& requests) {
    HistogramRequest request;
    FieldReader fields(item, path);
    readColourMode(fields, request.mode);
    fields.text("attribute", request.attribute);
    fields.number("bins", request.bins, std::size_t{1}, maxHistogramBins);
    Range range;
    fields.range("range", range);
    if (range.min < range.max)
        request.range = range;
    bool hasValues =
        request.mode == ColourMode::elevation || !attributeOf(request.mode, request.attribute).empty();
    if (!hasValues)
        fields.fail("colourMode", say("must be elevation or one that shows an attribute"));
    requests.push_back(std::move(request));
    return fields.finish();
}

json histogramJson(const Histogram& one) {
    return {{"range", one.bins.empty() ? json(nullptr) : json{one.range.min, one.range.max}},
            {"bins", one.bins},
            {"below", one.below},
            {"above", one.above},
            {"points", one.points},
            {"without", one.without},
            {"coarse", one.coarse},
            {"min", one.min},
            {"max", one.max},
            {"mean", one.mean},
            {"deviation", one.deviation}};
}

} // namespace

Result<std::vector<HistogramRequest>> histogramRequestsFromJson(std::string_view text) {
    STIPPLE_TRY(value, parseJson(text, "histograms"));
    std::vector<HistogramRequest> requests;
    json named{{"histograms", std::move(value)}};
    FieldReader fields(named, "histograms");
    fields.list("histograms", maxHistogramRequests,
                [&](const json& item, const std::string& path) { return readRequest(item, path, requests); });
    STIPPLE_CHECK(fields.finish());
    return requests;
}

json toJson(const ViewCounts& counts) {
    json histograms = json::array();
    for (const Histogram& one : counts.histograms)
        histograms.push_back(histogramJson(one));
    return {{"points", counts.points},
            {"nodes", counts.nodes},
            {"nodesMissing", counts.nodesMissing},
            {"histograms", std::move(histograms)}};
}

} // namespace stipple
