// What the page calls (www/src/wasm/viewer.ts). One viewer a program. Texts go in as UTF-8 and come back in a
// buffer that stands until the next call; a call that can fail returns "" or the sentence that says why.
#include "client/web/browser_source.hpp"
#include "client/web/viewer.hpp"

#include <emscripten/emscripten.h>

using namespace stipple;
using web::Viewer;

namespace {

std::unique_ptr<Viewer> viewer;
std::string text;
Bytes regionMessage, regionBytes;
const std::uint8_t* partPixels = nullptr;

const char* give(std::string value) {
    text = std::move(value);
    return text.c_str();
}

const char* give(const Status& status) {
    return give(status.ok() ? std::string() : status.error().said());
}

} // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE const char* stipple_create() {
    Result<std::unique_ptr<Viewer>> created = Viewer::create();
    if (!created.ok())
        return give(created.error().said());
    viewer = std::move(*created);
    return give(std::string());
}
EMSCRIPTEN_KEEPALIVE void stipple_dispose() {
    viewer.reset();
}

// Clouds.
// In the world box from (x, y, z) to (toX, toY, toZ), as far as is known; an empty or infinite one: it is
// not.
EMSCRIPTEN_KEEPALIVE std::uint32_t stipple_add_url(const char* url, const char* name, double x, double y,
                                                   double z, double toX, double toY, double toZ) {
    return viewer->addUrl(url, name, {{x, y, z}, {toX, toY, toZ}});
}
EMSCRIPTEN_KEEPALIVE void stipple_open_now(std::uint32_t id) {
    viewer->openNow(id);
}
EMSCRIPTEN_KEEPALIVE std::uint32_t stipple_add_file(std::uint32_t file, const char* name, double sizeBytes) {
    return viewer->addFile(file, name, static_cast<std::uint64_t>(sizeBytes));
}
EMSCRIPTEN_KEEPALIVE void stipple_remove_cloud(std::uint32_t id) {
    viewer->removeCloud(id);
}
// Asks again for what could not be had; of all clouds: 0.
EMSCRIPTEN_KEEPALIVE void stipple_retry(std::uint32_t id) {
    viewer->retry(id == 0 ? std::nullopt : std::optional(id));
}
EMSCRIPTEN_KEEPALIVE void stipple_set_visible(std::uint32_t id, int visible) {
    viewer->setVisible(id, visible != 0);
}
EMSCRIPTEN_KEEPALIVE const char* stipple_clouds() {
    return give(viewer->cloudsJson());
}
EMSCRIPTEN_KEEPALIVE const char* stipple_cloud_facts(std::uint32_t id) {
    return give(viewer->cloudFactsJson(id));
}

// Camera, style, limits.
EMSCRIPTEN_KEEPALIVE void stipple_resize(int width, int height, int inParts) {
    viewer->resize(width, height, inParts != 0);
}
// The bytes are at stipple_part_pixels() then.
EMSCRIPTEN_KEEPALIVE const char* stipple_draw_part(int left, int bottom, int width, int height) {
    auto drawn = viewer->drawPart({left, bottom, width, height});
    if (!drawn.ok())
        return give(drawn.error().said());
    partPixels = drawn->data();
    return give(std::string());
}
EMSCRIPTEN_KEEPALIVE const std::uint8_t* stipple_part_pixels() {
    return partPixels;
}
EMSCRIPTEN_KEEPALIVE const char* stipple_set_camera(const char* json) {
    return give(viewer->setCamera(json));
}
EMSCRIPTEN_KEEPALIVE const char* stipple_set_style(const char* json) {
    return give(viewer->setStyle(json));
}
EMSCRIPTEN_KEEPALIVE const char* stipple_set_limits(const char* json) {
    return give(viewer->setLimits(json));
}
EMSCRIPTEN_KEEPALIVE const char* stipple_camera() {
    return give(viewer->cameraJson());
}
EMSCRIPTEN_KEEPALIVE const char* stipple_style() {
    return give(viewer->styleJson());
}
EMSCRIPTEN_KEEPALIVE const char* stipple_limits() {
    return give(viewer->limitsJson());
}
EMSCRIPTEN_KEEPALIVE void stipple_orbit(double dx, double dy) {
    viewer->orbit(dx, dy);
}
EMSCRIPTEN_KEEPALIVE void stipple_pan(double dx, double dy) {
    viewer->pan(dx, dy);
}
EMSCRIPTEN_KEEPALIVE void stipple_zoom(double factor, double x, double y) {
    viewer->zoom(factor, x, y);
}
EMSCRIPTEN_KEEPALIVE void stipple_orbit_about(double x, double y, double z, double dx, double dy) {
    viewer->orbitAbout({x, y, z}, dx, dy);
}
EMSCRIPTEN_KEEPALIVE void stipple_drag_ground(double x, double y, double z, double toX, double toY) {
    viewer->dragGround({x, y, z}, toX, toY);
}
EMSCRIPTEN_KEEPALIVE void stipple_drag_at_depth(double x, double y, double z, double toX, double toY) {
    viewer->dragAtDepth({x, y, z}, toX, toY);
}
EMSCRIPTEN_KEEPALIVE void stipple_zoom_to_point(double x, double y, double z, double factor) {
    viewer->zoomToPoint({x, y, z}, factor);
}
EMSCRIPTEN_KEEPALIVE void stipple_look_around(double dx, double dy) {
    viewer->lookAround(dx, dy);
}
EMSCRIPTEN_KEEPALIVE void stipple_walk(double forward, double right, double up, int level) {
    viewer->walk({forward, right, up, level != 0});
}
EMSCRIPTEN_KEEPALIVE const char* stipple_fly_to_camera(const char* json) {
    Result<double> length = viewer->flyToCamera(json);
    return give(length.ok() ? std::string() : length.error().said());
}
EMSCRIPTEN_KEEPALIVE double stipple_fly_to_point(double x, double y, double z, double part) {
    return viewer->flyToPoint({x, y, z}, part);
}
EMSCRIPTEN_KEEPALIVE double stipple_fly_to_cloud(std::uint32_t id) {
    return viewer->flyToCloud(id);
}
EMSCRIPTEN_KEEPALIVE int stipple_fly(double t) {
    return viewer->fly(t) ? 1 : 0;
}
EMSCRIPTEN_KEEPALIVE const char* stipple_set_track(const char* json) {
    Result<double> duration = viewer->setTrack(json);
    return give(duration.ok() ? std::string() : duration.error().said());
}
EMSCRIPTEN_KEEPALIVE int stipple_follow_track(double seconds) {
    return viewer->followTrack(seconds) ? 1 : 0;
}
EMSCRIPTEN_KEEPALIVE const char* stipple_show_view(const char* name) {
    return give(viewer->showView(name));
}
EMSCRIPTEN_KEEPALIVE const char* stipple_set_projection(const char* name) {
    return give(viewer->setProjection(name));
}

// What is under the pointer.
EMSCRIPTEN_KEEPALIVE const char* stipple_pick(double x, double y, int radius) {
    return give(viewer->pick(x, y, radius));
}
EMSCRIPTEN_KEEPALIVE const char* stipple_take_pick() {
    return give(viewer->takePickJson());
}
EMSCRIPTEN_KEEPALIVE const char* stipple_take_place() {
    return give(viewer->takePlaceJson());
}

// How often values occur in the picture.
EMSCRIPTEN_KEEPALIVE const char* stipple_count(const char* json) {
    return give(viewer->count(json));
}
EMSCRIPTEN_KEEPALIVE const char* stipple_take_counts() {
    return give(viewer->takeCountsJson());
}
EMSCRIPTEN_KEEPALIVE const char* stipple_drawn_style() {
    return give(viewer->drawnStyleJson());
}
EMSCRIPTEN_KEEPALIVE const char* stipple_gradients() {
    return give(Viewer::gradientsJson());
}

// Measuring.
EMSCRIPTEN_KEEPALIVE const char* stipple_measure(const char* json) {
    return give(Viewer::measureJson(json));
}
EMSCRIPTEN_KEEPALIVE const char* stipple_project(const char* json) {
    return give(viewer->projectJson(json));
}
EMSCRIPTEN_KEEPALIVE const char* stipple_screen_polygon(const char* json) {
    return give(viewer->screenPolygonJson(json));
}

// Frames.
EMSCRIPTEN_KEEPALIVE void stipple_load() {
    viewer->load();
}
EMSCRIPTEN_KEEPALIVE int stipple_frame() {
    return viewer->frame() ? 1 : 0;
}
EMSCRIPTEN_KEEPALIVE void stipple_frame_took(double seconds) {
    viewer->frameTook(seconds);
}
EMSCRIPTEN_KEEPALIVE void stipple_refine_at_rest() {
    viewer->refineAtRest();
}
EMSCRIPTEN_KEEPALIVE void stipple_redraw() {
    viewer->redraw();
}
EMSCRIPTEN_KEEPALIVE int stipple_settled() {
    return viewer->settled() ? 1 : 0;
}
EMSCRIPTEN_KEEPALIVE const char* stipple_counters() {
    return give(viewer->countersJson());
}
EMSCRIPTEN_KEEPALIVE const char* stipple_errors() {
    return give(viewer->errorsJson());
}
EMSCRIPTEN_KEEPALIVE void stipple_context_lost() {
    viewer->contextLost();
}
EMSCRIPTEN_KEEPALIVE const char* stipple_context_restored() {
    return give(viewer->contextRestored());
}

// Scans of regions. What a call hands out stands until the next.
EMSCRIPTEN_KEEPALIVE std::size_t stipple_region_metadata(std::uint32_t cloud) {
    regionMessage = viewer->metadataOf(cloud);
    return regionMessage.size();
}
// The scan's number as text, or a sentence.
EMSCRIPTEN_KEEPALIVE const char* stipple_region_scan(const char* json) {
    Result<RegionScanId> scan = viewer->scanRegion(json);
    return scan.ok() ? give(std::to_string(*scan)) : give(scan.error().said());
}
// The size of the next node's message; 0: none is here.
EMSCRIPTEN_KEEPALIVE std::size_t stipple_region_take(int scan) {
    auto node = viewer->takeRegionNode(scan);
    regionMessage = node ? std::move(node->first) : Bytes();
    regionBytes = node ? std::move(node->second) : Bytes();
    return regionMessage.size();
}
EMSCRIPTEN_KEEPALIVE const std::uint8_t* stipple_region_message() {
    return regionMessage.data();
}
EMSCRIPTEN_KEEPALIVE const std::uint8_t* stipple_region_bytes() {
    return regionBytes.data();
}
EMSCRIPTEN_KEEPALIVE std::size_t stipple_region_bytes_size() {
    return regionBytes.size();
}
EMSCRIPTEN_KEEPALIVE const char* stipple_region_progress(int scan) {
    return give(viewer->regionProgressJson(scan));
}
EMSCRIPTEN_KEEPALIVE void stipple_region_end(int scan) {
    viewer->endRegionScan(scan);
    regionMessage = regionBytes = {};
}

// Answers of the page to reads (client/web/browser_source.hpp). `contentLength` < 0: not said.
EMSCRIPTEN_KEEPALIVE double stipple_read_headers(std::uint32_t request, int status, const char* contentRange,
                                                 const char* etag, const char* lastModified,
                                                 double contentLength, const char* retryAfter) {
    RangeAnswer answer{status, contentRange, etag, lastModified, std::nullopt, retryAfter};
    if (contentLength >= 0)
        answer.contentLength = static_cast<std::uint64_t>(contentLength);
    return web::acceptHeaders(request, answer);
}
EMSCRIPTEN_KEEPALIVE void stipple_read_is_stored(std::uint32_t request) {
    web::markStored(request);
}
EMSCRIPTEN_KEEPALIVE std::uint8_t* stipple_read_buffer(std::uint32_t request, std::size_t size) {
    return web::bodyBuffer(request, size);
}
EMSCRIPTEN_KEEPALIVE void stipple_read_done(std::uint32_t request) {
    web::finishBody(request);
}
EMSCRIPTEN_KEEPALIVE void stipple_read_failed(std::uint32_t request, int failure, const char* detail) {
    web::failRead(request, static_cast<web::ReadFailure>(failure), detail);
}

// Answers of workers (client/web/worker_decoder.hpp).
EMSCRIPTEN_KEEPALIVE int stipple_decode_answer(std::uint32_t job, const std::uint8_t* message,
                                               std::size_t size) {
    return viewer->decoder().answer(job, {message, size}) ? 1 : 0;
}
EMSCRIPTEN_KEEPALIVE std::uint8_t* stipple_decode_array(std::uint32_t job, int index, std::size_t sizeBytes) {
    return viewer->decoder().arrayBytes(job, index, sizeBytes);
}
EMSCRIPTEN_KEEPALIVE void stipple_decode_done(std::uint32_t job) {
    viewer->decoder().finish(job);
}
EMSCRIPTEN_KEEPALIVE void stipple_decode_failed(std::uint32_t job, const char* detail) {
    viewer->decoder().fail(job, detail);
}

} // extern "C"
