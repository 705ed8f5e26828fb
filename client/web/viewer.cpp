#include "client/web/viewer.hpp"

#include "client/core/attribute_needs.hpp"
#include "client/core/camera.hpp"
#include "client/core/cloud_facts.hpp"
#include "client/core/gradients.hpp"
#include "client/core/json.hpp"
#include "client/core/point_query.hpp"
#include "client/core/region_json.hpp"
#include "client/core/screen_polygon.hpp"
#include "client/render/picture_parts.hpp"
#include "client/survey/measure_json.hpp"
#include "client/web/browser_source.hpp"
#include "client/web/host.hpp"

#include <nlohmann/json.hpp>

#include <emscripten/heap.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace stipple::web {
namespace {

Error contextError() {
    return {ErrorCode::unsupported, "this browser gives the page no WebGL2", "",
            "switch hardware acceleration on, or use another browser"};
}

// A frame that brings more to the GPU than this is late on many machines.
SessionLimits pageLimits() {
    SessionLimits limits;
    limits.uploadBytes = 4 << 20;
    return limits;
}

} // namespace

Viewer::Viewer()
    : decoder_(std::make_unique<WorkerDecoder>()), session_(ViewSession::create(*decoder_, pageLimits())) {
    session_->setViewport(width_, height_);
}

Result<std::unique_ptr<Viewer>> Viewer::create() {
    std::unique_ptr<Viewer> viewer(new Viewer);
    STIPPLE_CHECK(viewer->contextRestored());
    return viewer;
}

CloudId Viewer::add(std::unique_ptr<ByteSource> source, const std::string& name, const BoxD& expected) {
    if (session_->clouds().empty() && !cameraWasSet_)
        pendingView_ = NamedView::iso;
    return session_->addCloud(std::move(source), name, expected);
}

CloudId Viewer::addUrl(const std::string& url, const std::string& name, const BoxD& expected) {
    return add(makeFetchSource(url), name, expected);
}

CloudId Viewer::addFile(std::uint32_t file, const std::string& name, std::uint64_t sizeBytes) {
    return add(makeFileSource(file, name, sizeBytes), name);
}

void Viewer::removeCloud(CloudId id) {
    session_->removeCloud(id);
    decoder_->forgetCloud(id);
    cameraWasSet_ &= !session_->clouds().empty();
}

void Viewer::setVisible(CloudId id, bool visible) {
    session_->setVisible(id, visible);
}

std::string Viewer::cloudsJson() const {
    nlohmann::json list = nlohmann::json::array();
    for (const CloudState& cloud : session_->clouds())
        list.push_back(toJson(cloud));
    return jsonText(list);
}

std::string Viewer::cloudFactsJson(CloudId id) const {
    for (const CloudState& cloud : session_->clouds())
        if (cloud.id == id && cloud.metadata)
            return jsonText(stipple::cloudFactsJson(*cloud.metadata));
    return jsonText(nullptr);
}

void Viewer::resize(int width, int height, bool inParts) {
    width_ = width;
    height_ = height;
    inParts_ = inParts;
    partsBegun_ = false;
    if (!inParts) {
        partTarget_ = {};
        partPixels_ = {};
    }
    session_->setViewport(width, height);
}

Status Viewer::setCamera(std::string_view json) {
    STIPPLE_TRY(camera, cameraFromJson(json, session_->camera()));
    session_->setCamera(camera);
    cameraWasSet_ = true;
    pendingView_.reset();
    return {};
}

Status Viewer::setStyle(std::string_view json) {
    STIPPLE_TRY(style, styleFromJson(json, session_->style()));
    session_->setStyle(style);
    return {};
}

Status Viewer::setLimits(std::string_view json) {
    STIPPLE_TRY(value, parseJson(json, "limits"));
    STIPPLE_TRY(limits, limitsFromJson(value, session_->limits()));
    session_->setLimits(limits);
    return {};
}

std::string Viewer::cameraJson() const {
    return jsonText(toJson(session_->camera()));
}
std::string Viewer::styleJson() const {
    return jsonText(toJson(session_->style()));
}
std::string Viewer::limitsJson() const {
    return jsonText(toJson(session_->limits()));
}

void Viewer::orbit(double dx, double dy) {
    session_->setCamera(stipple::orbit(session_->camera(), dx, dy, height_));
}
void Viewer::pan(double dx, double dy) {
    session_->setCamera(stipple::pan(session_->camera(), dx, dy, height_));
}
void Viewer::zoom(double factor, double x, double y) {
    session_->setCamera(zoomTo(session_->camera(), factor, x, y, width_, height_));
}

void Viewer::orbitAbout(Vec3d pivot, double dx, double dy) {
    session_->setCamera(stipple::orbitAbout(session_->camera(), pivot, dx, dy, height_));
}
void Viewer::dragGround(Vec3d grabbed, double x, double y) {
    session_->setCamera(stipple::dragGround(session_->camera(), grabbed, x, y, width_, height_));
}
void Viewer::dragAtDepth(Vec3d grabbed, double x, double y) {
    session_->setCamera(stipple::dragAtDepth(session_->camera(), grabbed, x, y, width_, height_));
}
void Viewer::zoomToPoint(Vec3d point, double factor) {
    session_->setCamera(stipple::zoomToPoint(session_->camera(), point, factor));
}
void Viewer::lookAround(double dx, double dy) {
    session_->setCamera(stipple::lookAround(session_->camera(), dx, dy, height_));
}
void Viewer::walk(const Walk& step) {
    session_->setCamera(stipple::walk(session_->camera(), step));
}

double Viewer::begin(const Camera& destination) {
    pendingView_.reset();
    flight_.emplace(session_->camera(), destination);
    flown_ = session_->camera();
    return flight_->length();
}

Result<double> Viewer::flyToCamera(std::string_view json) {
    STIPPLE_TRY(camera, cameraFromJson(json, session_->camera()));
    return begin(camera);
}
double Viewer::flyToPoint(Vec3d point, double part) {
    return begin(facing(session_->camera(), point, part));
}
double Viewer::flyToCloud(CloudId id) {
    BoxD content = session_->contentBounds();
    for (const CloudState& cloud : session_->clouds())
        if (cloud.id == id && (cloud.metadata || !cloud.expected.empty()))
            content = cloud.metadata ? cloud.metadata->worldBounds() : cloud.expected;
    return content.empty() ? 0 : begin(fittedCamera(session_->camera(), content, aspect()));
}

bool Viewer::fly(double t) {
    if (!flight_ || session_->camera() != flown_) {
        flight_.reset();
        return false;
    }
    session_->setCamera(flight_->at(t));
    flown_ = session_->camera();
    if (t >= 1)
        flight_.reset();
    return true;
}

Result<double> Viewer::setTrack(std::string_view json) {
    STIPPLE_TRY(track, cameraTrackFromJson(json));
    track_ = std::move(track);
    return track_->duration();
}
bool Viewer::followTrack(double seconds) {
    if (!track_)
        return false;
    pendingView_.reset();
    session_->setCamera(track_->at(seconds));
    return true;
}

Status Viewer::showView(const std::string& name) {
    pendingView_ = namedViewFromName(name);
    if (!pendingView_)
        return Error{ErrorCode::invalidArgument, "the views are top, front, side and iso", name, ""};
    applyPendingView();
    return {};
}

Status Viewer::setProjection(const std::string& name) {
    nlohmann::json change{{"projection", name}};
    STIPPLE_TRY(camera, cameraFromJson(change, session_->camera()));
    session_->setCamera(withProjection(session_->camera(), camera.projection));
    return {};
}

void Viewer::applyPendingView() {
    BoxD content = session_->contentBounds();
    if (!pendingView_ || content.empty())
        return;
    session_->setCamera(namedCamera(*pendingView_, content, aspect(), session_->camera().projection));
    pendingView_.reset();
}

void Viewer::load() {
    session_->load();
    if (!pendingViewIsDue())
        return;
    applyPendingView();
    session_->load();
}

// What was skipped may have changed where the picture has not.
void Viewer::keepCounters() {
    FrameCounters before = std::exchange(drawn_.counters, session_->plan().counters);
    drawn_.counters.passesRun = before.passesRun;
    drawn_.counters.passesSkipped = before.passesSkipped;
}

bool Viewer::frame() {
    if (!renderer_ || partsBegun_)
        return false;
    bool isNew = session_->update();
    if (session_->regionsMustGoOn())
        stippleHostWake();
    if (pendingViewIsDue()) {
        applyPendingView();
        isNew = session_->update() || isNew;
    }
    if (!isNew && !drawAgain_) {
        keepCounters();
        return false;
    }
    drawAgain_ = false;
    drawn_ = session_->plan();
    if (drawn_.counters.nodesDelayed > 0)
        stippleHostWake(); // they come with the next frame
    if (inParts_)
        return true;
    Status status = renderer_->draw(drawn_);
    drawError_ = status.ok() ? std::nullopt : std::optional(status.error());
    return true;
}

Result<ByteSpan> Viewer::drawPart(const PictureWindow& kept) {
    if (!renderer_)
        return contextError();
    partsBegun_ = true;
    PictureWindow part = withMargin(kept, drawn_);
    STIPPLE_CHECK(partTarget_.resize(part.width, part.height));
    drawn_.part = part;
    Status drawn = renderer_->draw(drawn_, partTarget_.framebuffer.id());
    drawn_.part = {};
    STIPPLE_CHECK(drawn);
    partPixels_.resize(4 * static_cast<std::size_t>(kept.width) * static_cast<std::size_t>(kept.height));
    glReadPixels(kept.left - part.left, kept.bottom - part.bottom, kept.width, kept.height, GL_RGBA,
                 GL_UNSIGNED_BYTE, partPixels_.data());
    return ByteSpan(partPixels_);
}

namespace {
PointIdentity identityOf(const PickHit& hit) {
    return {hit.cloud, hit.node->key, hit.point};
}
// What measuring from a point needs to know of its cloud.
void addPlace(nlohmann::json& point, const CloudState& cloud, const PointIdentity& identity) {
    if (!cloud.metadata)
        return;
    const CloudMetadata& metadata = *cloud.metadata;
    const Crs& crs = metadata.crs;
    auto list = [](Vec3d v) { return nlohmann::json{v.x, v.y, v.z}; };
    point["crs"] = crs.name;
    point["epsg"] = crs.epsg ? nlohmann::json(*crs.epsg) : nlohmann::json(nullptr);
    point["unit"] = crs.unit;
    point["unitMeters"] = crs.unitMeters;
    point["geocentric"] = isGeocentric(crs);
    point["scale"] = list(metadata.grid.scale);
    point["offset"] = list(metadata.grid.offset);
    point["spacing"] = std::ldexp(metadata.spacing, -identity.node.level);
}
std::string pickError(const Error& error) {
    return jsonText({{"pending", false}, {"error", error.sentence()}});
}
} // namespace

Status Viewer::pick(double x, double y, int radius) {
    picked_.reset();
    if (!renderer_ || drawn_.width == 0)
        return Error{ErrorCode::invalidArgument, "there is no picture yet", "", ""};
    return renderer_->startPick(drawn_, {x, y, radius});
}

nlohmann::json Viewer::pickedJson(const PickHit& hit, const PointRecord& record) const {
    nlohmann::json point = toJson(record);
    point["point"] = toJson(identityOf(hit));
    point["pixelsAway"] = hit.pixelsAway;
    point["distance"] = hit.distance;
    for (const CloudState& cloud : session_->clouds())
        if (cloud.id == hit.cloud) {
            point["cloudName"] = cloud.name;
            addPlace(point, cloud, identityOf(hit));
        }
    return point;
}

std::variant<PickHit, std::string> Viewer::takeHit(const char* name) {
    const std::string nothing = jsonText({{"pending", false}, {name, nullptr}});
    if (!renderer_ || !renderer_->pickPending())
        return nothing;
    auto answer = renderer_->takePick();
    if (!answer.ok())
        return pickError(answer.error());
    if (!*answer)
        return jsonText({{"pending", true}});
    if (!(*answer)->hit)
        return nothing;
    return *(*answer)->hit;
}

std::string Viewer::takePickJson() {
    if (!picked_) {
        auto answer = takeHit("point");
        if (auto* json = std::get_if<std::string>(&answer))
            return *json;
        picked_ = std::get<PickHit>(answer);
        session_->takePointAnswers(); // of questions that nobody waits for any more
        if (Status asked = session_->askPoint(identityOf(*picked_)); !asked.ok()) {
            picked_.reset();
            return pickError(asked.error());
        }
    }
    for (const PointAnswer& answer : session_->takePointAnswers())
        if (answer.point == identityOf(*picked_)) {
            PickHit hit = *std::exchange(picked_, std::nullopt);
            if (!answer.record.ok())
                return pickError(answer.record.error());
            return jsonText({{"pending", false}, {"point", pickedJson(hit, *answer.record)}});
        }
    return jsonText({{"pending", true}});
}

// --- counting ------------------------------------------------------------------------------------------

namespace {
// A few milliseconds.
constexpr std::uint64_t pointsCountedAtOnce = 100'000;
constexpr int shownGradientStops = 64;
} // namespace

Status Viewer::count(std::string_view json) {
    STIPPLE_TRY(requests, histogramRequestsFromJson(json));
    session_->watchAttributes(attributesOf(requests));
    counter_.reset();
    if (!requests.empty())
        counter_.emplace(session_->countedView(), std::move(requests));
    return {};
}

std::string Viewer::takeCountsJson() {
    if (!counter_)
        return jsonText({{"pending", false}});
    if (!counter_->advance(pointsCountedAtOnce))
        return jsonText({{"pending", true}});
    nlohmann::json counts = toJson(counter_->counts());
    counter_.reset();
    return jsonText({{"pending", false}, {"counts", std::move(counts)}});
}

std::string Viewer::jsonOf(const Style& style) {
    return jsonText(toJson(style));
}

std::string Viewer::gradientsJson() {
    nlohmann::json gradients = nlohmann::json::object();
    for (GradientName name : {GradientName::viridis, GradientName::turbo, GradientName::inferno,
                              GradientName::spectral, GradientName::grey, GradientName::terrain}) {
        nlohmann::json colours = nlohmann::json::array();
        for (int i = 0; i < shownGradientStops; ++i) {
            auto entry = static_cast<std::size_t>(i * (gradientEntries - 1) / (shownGradientStops - 1));
            std::uint32_t word = gradientTable(name)[entry];
            colours.push_back({word & 255, word >> 8 & 255, word >> 16 & 255});
        }
        gradients[gradientNameText(name)] = {{"colours", std::move(colours)},
                                             {"isColourBlindSafe", isColourBlindSafe(name)}};
    }
    return jsonText(gradients);
}

std::string Viewer::measureJson(std::string_view request) {
    Result<nlohmann::json> parsed = parseJson(request, "measurement");
    Result<nlohmann::json> answer = parsed.ok() ? survey::measureJson(*parsed) : parsed;
    if (!answer.ok())
        return jsonText({{"error", answer.error().sentence()}});
    return jsonText({{"answer", *answer}});
}

std::string Viewer::projectJson(std::string_view positions) const {
    Result<nlohmann::json> parsed = parseJson(positions, "positions");
    nlohmann::json places = nlohmann::json::array();
    if (!parsed.ok() || !parsed->is_array() || drawn_.width == 0)
        return jsonText(places);
    auto isNumber = [](const nlohmann::json& value) { return value.is_number(); };
    for (const nlohmann::json& position : *parsed) {
        if (!position.is_array() || position.size() != 3 ||
            !std::all_of(position.begin(), position.end(), isNumber)) {
            places.push_back(nullptr);
            continue;
        }
        Vec3d world{position[0].get<double>(), position[1].get<double>(), position[2].get<double>()};
        Vec3d pixel = projectToPixels(drawn_.view, drawn_.width, drawn_.height, world);
        bool isBehind = drawn_.view.projection == Projection::perspective && !(pixel.z > 0);
        places.push_back(isBehind ? nlohmann::json(nullptr) : nlohmann::json{pixel.x, pixel.y, pixel.z});
    }
    return jsonText(places);
}

std::string Viewer::screenPolygonJson(std::string_view corners) const {
    Result<nlohmann::json> parsed = parseJson(corners, "corners");
    std::vector<Point2d> places;
    if (parsed.ok() && parsed->is_array())
        for (const nlohmann::json& corner : *parsed)
            if (corner.is_array() && corner.size() == 2 && corner[0].is_number() && corner[1].is_number())
                places.push_back({corner[0].get<double>(), corner[1].get<double>()});
    return jsonText(toJson(screenPolygon(drawn_.view, drawn_.width, drawn_.height, places)));
}

std::string Viewer::takePlaceJson() {
    auto answer = takeHit("place");
    if (auto* json = std::get_if<std::string>(&answer))
        return *json;
    const PickHit& hit = std::get<PickHit>(answer);
    for (const CloudState& cloud : session_->clouds())
        if (cloud.id == hit.cloud && cloud.metadata) {
            Vec3d place = positionRecord(*cloud.metadata, *hit.node, hit.point).position;
            return jsonText({{"pending", false}, {"place", {place.x, place.y, place.z}}});
        }
    return jsonText({{"pending", false}, {"place", nullptr}});
}

bool Viewer::settled() const {
    return !pendingViewIsDue() && session_->settled();
}

std::string Viewer::countersJson() const {
    return jsonText({{"frame", toJson(drawn_.counters)},
                     {"session", toJson(session_->counters())},
                     {"gpuBytes", renderer_ ? renderer_->gpuBytes() : 0},
                     {"heapBytes", emscripten_get_heap_size()},
                     {"decodesPending", decoder_->pending()},
                     {"settled", settled()}});
}

std::string Viewer::errorsJson() const {
    nlohmann::json list = nlohmann::json::array(); // what clouds lack is in their states
    if (drawError_)
        list.push_back(drawError_->sentence());
    if (renderer_ && !renderer_->limitation().empty())
        list.push_back(std::string(renderer_->limitation()));
    for (const CloudState& cloud : session_->clouds())
        if (cloud.metadata && cloud.visible)
            if (std::string lack = lackOf(session_->style(), *cloud.metadata, cloud.name); !lack.empty())
                list.push_back(std::move(lack));
    return jsonText(list);
}

void Viewer::contextLost() {
    renderer_.reset();
    partTarget_ = {};
}

Status Viewer::contextRestored() {
    if (!stippleHostCreateContext())
        return contextError();
    STIPPLE_TRY(renderer, GlesRenderer::create());
    renderer_ = std::move(renderer);
    drawAgain_ = true;
    return {};
}

} // namespace stipple::web
