#include "client/core/json.hpp"

#include "client/core/colour_json.hpp"
#include "client/core/node_normals.hpp"
#include "shared/base/json_fields.hpp"
#include "shared/points/point_classes.hpp"

namespace stipple {

using nlohmann::json;

namespace {

template <class T, std::size_t N>
using Names = json_fields::Names<T, N>;
using json_fields::FieldReader;
using json_fields::nameOf;

constexpr Names<Projection, 2> projections{{
    {"perspective", Projection::perspective},
    {"orthographic", Projection::orthographic},
}};
constexpr Names<NamedView, 4> namedViews{{
    {"top", NamedView::top},
    {"front", NamedView::front},
    {"side", NamedView::side},
    {"iso", NamedView::iso},
}};
constexpr Names<PointSizeMode, 4> sizeModes{{
    {"fixed", PointSizeMode::fixed},
    {"world", PointSizeMode::world},
    {"spacing", PointSizeMode::spacing},
    {"adaptive", PointSizeMode::adaptive},
}};
constexpr Names<DetailMode, 2> detailModes{{
    {"discrete", DetailMode::discrete},
    {"continuous", DetailMode::continuous},
}};
constexpr Names<PointShape, 4> shapes{{
    {"square", PointShape::square},
    {"circle", PointShape::circle},
    {"paraboloid", PointShape::paraboloid},
    {"disc", PointShape::disc},
}};
constexpr Names<DelayedExpansion, 3> expansions{{
    {"off", DelayedExpansion::off},
    {"on", DelayedExpansion::on},
    {"auto", DelayedExpansion::automatic},
}};
constexpr Names<CloudStage, 4> stages{{
    {"waiting", CloudStage::waiting},
    {"opening", CloudStage::opening},
    {"ready", CloudStage::ready},
    {"failed", CloudStage::failed},
}};

constexpr double largestCoordinate = 1e150; // squares stay finite

json vectorJson(const Vec3d& v) {
    return json::array({v.x, v.y, v.z});
}

// The classes of the cloud's points, by value: names and colours are point_classes.hpp's. Empty if it has
// none, or too many to be counted.
json classesJson(const CloudMetadata& metadata) {
    json classes = json::array();
    auto at = static_cast<std::size_t>(metadata.schema.find(attribute_names::classification));
    if (at >= metadata.statistics.size())
        return classes;
    for (auto [value, points] : metadata.statistics[at].histogram)
        if (value >= 0 && value <= 255)
            classes.push_back({{"class", value},
                               {"name", className(metadata.schema, static_cast<int>(value))},
                               {"colour", classColour(static_cast<std::uint8_t>(value))},
                               {"points", points}});
    return classes;
}

void readDetail(FieldReader& fields, Detail& detail) {
    fields.choice("mode", detail.mode, detailModes);
    fields.number("spacingPixels", detail.spacingPixels, 0.01, 1000);
    fields.number("growthRange", detail.growthRange, 0, 0.99);
    fields.number("peripheralFalloff", detail.peripheralFalloff, 0, 1);
    fields.number("peripheralDensity", detail.peripheralDensity, 0.01, 1);
}

void readSplats(FieldReader& fields, Splats& splats) {
    fields.flag("enabled", splats.enabled);
    fields.number("hardness", splats.hardness, 1, 16);
    fields.number("depthFactor", splats.depthFactor, 0, 1);
}

void readEdl(FieldReader& fields, EyeDomeLighting& edl) {
    fields.flag("enabled", edl.enabled);
    fields.number("neighbours", edl.neighbours, 4, 8);
    if (edl.neighbours != 4 && edl.neighbours != 8)
        fields.fail("neighbours", say("must be 4 or 8"));
    fields.number("radiusPixels", edl.radiusPixels, 0, 100);
    fields.number("strength", edl.strength, 0, 100);
}

} // namespace

Result<json> parseJson(std::string_view text, const std::string& what) {
    // The parser tells the position only by exceptions, which WebAssembly is built without.
    json value = json::parse(text.begin(), text.end(), nullptr, false);
    if (value.is_discarded())
        return Error{ErrorCode::invalidArgument, say("this is not valid JSON"), what,
                     say("check quotes, commas and brackets")};
    return value;
}

std::string jsonText(const json& value) {
    return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

Result<Camera> detail::readCamera(const json& value, const Camera& base) {
    Camera camera = base;
    FieldReader fields(value, "camera");
    fields.choice("projection", camera.projection, projections);
    fields.vector("position", camera.position, largestCoordinate);
    fields.vector("target", camera.target, largestCoordinate);
    fields.vector("up", camera.up, largestCoordinate);
    fields.number("fovYDegrees", camera.fovYDegrees, 0.001, 179);
    fields.number("orthoHeight", camera.orthoHeight, 1e-150, largestCoordinate);
    STIPPLE_CHECK(fields.finish());
    return camera;
}

Result<Camera> cameraFromJson(std::string_view text, const Camera& base) {
    STIPPLE_TRY(value, parseJson(text, "camera"));
    return cameraFromJson(value, base);
}

Result<Style> detail::readStyle(const json& value, const Style& base) {
    Style style = base;
    FieldReader fields(value, "style");
    readColours(fields, style);
    fields.choice("sizeMode", style.sizeMode, sizeModes);
    fields.number("sizePixels", style.sizePixels, 0.01, 1000);
    fields.number("sizeWorld", style.sizeWorld, 0, 1e15);
    fields.number("sizeSpacings", style.sizeSpacings, 0, 1000);
    fields.number("minSizePixels", style.minSizePixels, 0.01, 1000);
    fields.number("maxSizePixels", style.maxSizePixels, 0.01, 1000);
    if (style.minSizePixels > style.maxSizePixels)
        fields.fail("minSizePixels", say("must not exceed maxSizePixels"));
    fields.flag("growsWhileLoading", style.growsWhileLoading);
    fields.choice("shape", style.shape, shapes);
    fields.choice("delayedExpansion", style.delayedExpansion, expansions);
    fields.object("splats", [&](FieldReader& splats) { readSplats(splats, style.splats); });
    fields.object("detail", [&](FieldReader& detail) { readDetail(detail, style.detail); });
    fields.object("edl", [&](FieldReader& edl) { readEdl(edl, style.edl); });
    fields.bytes("background", style.background);
    STIPPLE_CHECK(fields.finish());
    return style;
}

Result<Style> styleFromJson(std::string_view text, const Style& base) {
    STIPPLE_TRY(value, parseJson(text, "style"));
    return styleFromJson(value, base);
}

Result<SessionLimits> detail::readLimits(const json& value, const SessionLimits& base) {
    constexpr std::uint64_t most = 1ull << 50; // JSON numbers are exact to 2^53
    SessionLimits limits = base;
    FieldReader fields(value, "limits");
    fields.number("pointBudget", limits.pointBudget, 1, most);
    fields.number("minNodePixels", limits.minNodePixels, 0, 1e6);
    fields.number("frameMilliseconds", limits.frameMilliseconds, 0, 60'000);
    fields.number("leastCentreWeight", limits.weights.leastCentre, 0, 1);
    fields.number("leastDepthWeight", limits.weights.leastDepth, 0, 1);
    fields.number("cacheBytes", limits.cacheBytes, 1, most);
    fields.number("compressedBytes", limits.compressedBytes, 0, most);
    fields.number("gpuBytes", limits.gpuBytes, 0, most);
    fields.number("uploadBytes", limits.uploadBytes, 0, most);
    fields.number("requestsInFlight", limits.requestsInFlight, 1, 1000);
    fields.number("bytesInFlight", limits.bytesInFlight, 1, most);
    fields.number("mergeGapBytes", limits.mergeGapBytes, 0, most);
    fields.number("mergedRequestBytes", limits.mergedRequestBytes, 0, most);
    STIPPLE_CHECK(fields.finish());
    return limits;
}

Result<SessionLimits> limitsFromJson(std::string_view text, const SessionLimits& base) {
    STIPPLE_TRY(value, parseJson(text, "limits"));
    return limitsFromJson(value, base);
}

std::optional<NamedView> namedViewFromName(std::string_view name) {
    for (const auto& [text, view] : namedViews)
        if (name == text)
            return view;
    return std::nullopt;
}

json toJson(const Camera& camera) {
    return {{"projection", nameOf(projections, camera.projection)},
            {"position", vectorJson(camera.position)},
            {"target", vectorJson(camera.target)},
            {"up", vectorJson(camera.up)},
            {"fovYDegrees", camera.fovYDegrees},
            {"orthoHeight", camera.orthoHeight}};
}

json toJson(const Style& style) {
    json edl = {{"enabled", style.edl.enabled},
                {"neighbours", style.edl.neighbours},
                {"radiusPixels", style.edl.radiusPixels},
                {"strength", style.edl.strength}};
    json splats = {{"enabled", style.splats.enabled},
                   {"hardness", style.splats.hardness},
                   {"depthFactor", style.splats.depthFactor}};
    json detail = {{"mode", nameOf(detailModes, style.detail.mode)},
                   {"spacingPixels", style.detail.spacingPixels},
                   {"growthRange", style.detail.growthRange},
                   {"peripheralFalloff", style.detail.peripheralFalloff},
                   {"peripheralDensity", style.detail.peripheralDensity}};
    json all = coloursJson(style);
    all.update({{"sizeMode", nameOf(sizeModes, style.sizeMode)},
                {"sizePixels", style.sizePixels},
                {"sizeWorld", style.sizeWorld},
                {"sizeSpacings", style.sizeSpacings},
                {"minSizePixels", style.minSizePixels},
                {"maxSizePixels", style.maxSizePixels},
                {"growsWhileLoading", style.growsWhileLoading},
                {"shape", nameOf(shapes, style.shape)},
                {"splats", splats},
                {"delayedExpansion", nameOf(expansions, style.delayedExpansion)},
                {"detail", detail},
                {"edl", edl},
                {"background", style.background}});
    return all;
}

json toJson(const SessionLimits& limits) {
    return {{"pointBudget", limits.pointBudget},
            {"minNodePixels", limits.minNodePixels},
            {"frameMilliseconds", limits.frameMilliseconds},
            {"leastCentreWeight", limits.weights.leastCentre},
            {"leastDepthWeight", limits.weights.leastDepth},
            {"cacheBytes", limits.cacheBytes},
            {"compressedBytes", limits.compressedBytes},
            {"gpuBytes", limits.gpuBytes},
            {"uploadBytes", limits.uploadBytes},
            {"requestsInFlight", limits.requestsInFlight},
            {"bytesInFlight", limits.bytesInFlight},
            {"mergeGapBytes", limits.mergeGapBytes},
            {"mergedRequestBytes", limits.mergedRequestBytes}};
}

json toJson(const FrameCounters& c) {
    return {{"cloudsWaiting", c.cloudsWaiting},       {"nodesKnown", c.nodesKnown},
            {"nodesVisited", c.nodesVisited},         {"nodesOutsideFrustum", c.nodesOutsideFrustum},
            {"nodesClipped", c.nodesClipped},         {"nodesHidden", c.nodesHidden},
            {"nodesOutsidePart", c.nodesOutsidePart}, {"nodesTooSmall", c.nodesTooSmall},
            {"nodesOverBudget", c.nodesOverBudget},   {"nodesSelected", c.nodesSelected},
            {"nodesWaiting", c.nodesWaiting},         {"nodesDrawn", c.nodesDrawn},
            {"nodesDelayed", c.nodesDelayed},         {"pointsConsidered", c.pointsConsidered},
            {"pointsSelected", c.pointsSelected},     {"pointsDrawn", c.pointsDrawn},
            {"pointsExpected", c.pointsExpected},     {"pointsTooFine", c.pointsTooFine},
            {"pointsHidden", c.pointsHidden},         {"nodesExact", c.nodesExact},
            {"chunksWaiting", c.chunksWaiting},       {"passesRun", c.passesRun},
            {"passesSkipped", c.passesSkipped},       {"detailPixels", c.detailPixels},
            {"coarserForTime", c.coarserForTime},     {"complete", c.complete}};
}

json toJson(const SessionCounters& c) {
    return {{"framesDrawn", c.framesDrawn},
            {"framesSkipped", c.framesSkipped},
            {"selectionsRun", c.selectionsRun},
            {"selectionsSkipped", c.selectionsSkipped},
            {"requests", c.requests},
            {"requestsMerged", c.requestsMerged},
            {"requestsFailed", c.requestsFailed},
            {"requestsCancelled", c.requestsCancelled},
            {"requestsLetFinish", c.requestsLetFinish},
            {"requestsRetried", c.requestsRetried},
            {"bytesRequested", c.bytesRequested},
            {"bytesReceived", c.bytesReceived},
            {"bytesWasted", c.bytesWasted},
            {"bytesFetchedTwice", c.bytesFetchedTwice},
            {"networkBytesPerSecond", c.networkBytesPerSecond},
            {"networkDelaySeconds", c.networkDelaySeconds},
            {"cloudsReloaded", c.cloudsReloaded},
            {"chunksLoaded", c.chunksLoaded},
            {"nodesDecoded", c.nodesDecoded},
            {"pointsDecoded", c.pointsDecoded},
            {"nodesEvicted", c.nodesEvicted},
            {"attributeBytesOffered", c.attributeBytesOffered},
            {"attributeBytesFetched", c.attributeBytesFetched},
            {"nodesPainted", c.nodesPainted},
            {"columnsDropped", c.columnsDropped},
            {"bytesReused", c.bytesReused},
            {"cacheBytes", c.cacheBytes},
            {"cacheBytesPeak", c.cacheBytesPeak},
            {"compressedBytes", c.compressedBytes}};
}

json toJson(const Error& error) {
    return {{"code", errorCodeName(error.code)}, {"what", error.what.text()},    {"where", error.where},
            {"advice", error.advice.text()},     {"sentence", error.sentence()}, {"said", error.said()}};
}

json toJson(const BoxD& box) {
    if (box.empty())
        return nullptr;
    return {{"min", vectorJson(box.min)}, {"max", vectorJson(box.max)}};
}

json toJson(const CloudState& cloud) {
    json value = {{"id", cloud.id},
                  {"name", cloud.name},
                  {"stage", nameOf(stages, cloud.stage)},
                  {"visible", cloud.visible}};
    if (cloud.stage == CloudStage::failed)
        value["error"] = toJson(cloud.error);
    if (cloud.interrupted)
        value["interrupted"] = toJson(*cloud.interrupted);
    if (cloud.retrying) {
        value["retrying"] = toJson(*cloud.retrying);
        value["retrySeconds"] = cloud.retrySeconds;
    }
    if (cloud.lastLoss) {
        value["missing"] = {{"nodes", cloud.nodesMissing},
                            {"chunks", cloud.chunksMissing},
                            {"last", toJson(*cloud.lastLoss)}};
    }
    if (cloud.reloads > 0)
        value["reloads"] = cloud.reloads;
    if (!cloud.caution.empty())
        value["caution"] = cloud.caution;
    if (!cloud.metadata && !cloud.expected.empty())
        value["bounds"] = toJson(cloud.expected);
    if (cloud.metadata) {
        json attributes = json::array();
        for (const Attribute& attribute : cloud.metadata->schema.attributes)
            attributes.push_back(attribute.name);
        value["pointCount"] = cloud.metadata->pointCount;
        value["bounds"] = toJson(cloud.metadata->worldBounds());
        value["crs"] = cloud.metadata->crs.name;
        value["attributes"] = std::move(attributes);
        value["classes"] = classesJson(*cloud.metadata);
        value["hasNormals"] = normalAttributes(cloud.metadata->schema).has_value();
    }
    return value;
}

json toJson(const PointRecord& record) {
    auto valueJson = [](const PointValue& value, std::size_t i) -> json {
        if (value.attribute.scale != 1 || value.attribute.offset != 0)
            return value.value(i);
        return std::visit([](auto stored) { return json(stored); }, value.stored[i]);
    };
    json values = json::object();
    for (const PointValue& value : record.values) {
        json list = json::array();
        for (std::size_t i = 0; i < value.stored.size(); ++i)
            list.push_back(valueJson(value, i));
        values[value.attribute.name] = list.size() == 1 ? list[0] : list;
    }
    return {{"integers", {record.integers.x, record.integers.y, record.integers.z}},
            {"position", vectorJson(record.position)},
            {"values", std::move(values)}};
}

json toJson(const PointIdentity& point) {
    return {{"cloud", point.cloud}, {"node", point.node.text()}, {"index", point.index}};
}

} // namespace stipple
