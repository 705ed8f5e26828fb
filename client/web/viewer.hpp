// The viewer on a page: a ViewSession whose picture a GlesRenderer draws on the canvas's WebGL2 context. The
// page calls frame() when it was woken or changed something, never otherwise.
#pragma once

#include "client/core/camera_track.hpp"
#include "client/core/navigation.hpp"
#include "client/core/view_session.hpp"
#include "client/render/gles_renderer.hpp"
#include "client/render/gles_targets.hpp"
#include "client/web/worker_decoder.hpp"

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace stipple::web {

class Viewer {
  public:
    // Needs the canvas of host.hpp. unsupported: no WebGL2, or a shader that does not compile.
    static Result<std::unique_ptr<Viewer>> create();

    // `expected`: see ViewSession::addCloud().
    CloudId addUrl(const std::string& url, const std::string& name, const BoxD& expected);
    void openNow(CloudId id) { session_->open(id); }
    CloudId addFile(std::uint32_t file, const std::string& name, std::uint64_t sizeBytes);
    void removeCloud(CloudId id);
    void setVisible(CloudId id, bool visible);
    void retry(std::optional<CloudId> only) { session_->retry(only); }
    // An array of clouds as in client/core/json.hpp.
    std::string cloudsJson() const;
    // client/core/cloud_facts.hpp; null unless the cloud is ready.
    std::string cloudFactsJson(CloudId id) const;

    // Pixels of the canvas; or of a picture in parts: frame() draws nothing then, drawPart() does. From the
    // first part on the picture stays as it is, until the next call.
    void resize(int width, int height, bool inParts = false);
    // Pixels of the present picture, within it: four bytes each, rows from the bottom. They stand until the
    // next call.
    Result<ByteSpan> drawPart(const PictureWindow& kept);
    Status setCamera(std::string_view json);
    Status setStyle(std::string_view json);
    Status setLimits(std::string_view json);
    std::string cameraJson() const;
    std::string styleJson() const;
    std::string limitsJson() const;

    // Steps of the camera; pixels as in client/core/camera.hpp.
    void orbit(double dx, double dy);
    void pan(double dx, double dy);
    void zoom(double factor, double x, double y);
    // Steps of client/core/navigation.hpp.
    void orbitAbout(Vec3d pivot, double dx, double dy);
    void dragGround(Vec3d grabbed, double x, double y);
    void dragAtDepth(Vec3d grabbed, double x, double y);
    void zoomToPoint(Vec3d point, double factor);
    void lookAround(double dx, double dy);
    void walk(const Walk& step);
    // Begins a flight: to a camera, to where `point` is in the middle at `part` of the distance, to where all
    // of a cloud shows (0: of all). Its length; 0: there is none to fly.
    Result<double> flyToCamera(std::string_view json);
    double flyToPoint(Vec3d point, double part);
    double flyToCloud(CloudId cloud);
    // Goes to t (0..1) of it; at 1 it is over. False if no flight is under way: another step of the camera
    // ends it.
    bool fly(double t);

    // The camera path that followTrack() goes along (client/core/camera_track.hpp): its duration in seconds.
    Result<double> setTrack(std::string_view json);
    // To where it is after so many seconds. False if there is none.
    bool followTrack(double seconds);

    // Shows everything from a named side; remembered until there is something to show.
    Status showView(const std::string& name);
    Status setProjection(const std::string& name);

    // Asks what is under the pointer in the present picture; x, y in pixels of the canvas from the top left.
    // The answer comes with takePickJson(), between frames: a new question takes the place of an older one.
    Status pick(double x, double y, int radius);
    // {"pending": true} while the GPU or the file has not answered; {"pending": false, "point": null} if
    // there is nothing; else "point" is the record (client/core/json.hpp) with "point", "pixelsAway",
    // "distance", "cloudName" and what measuring needs of its cloud: "crs", "epsg", "unit", "unitMeters",
    // "geocentric", "scale", "offset", and the "spacing" of the node. {"pending": false, "error": sentence}
    // for what can't be read.
    std::string takePickJson();
    // The same question, answered by the point's place alone, before anything is read: {"pending": …,
    // "place": [x, y, z] or null}.
    std::string takePlaceJson();

    // Asks how often values occur in the present picture: histograms of client/core/view_counter.hpp. What
    // they look at is fetched from then on, until another list is asked for ("[]": nothing).
    Status count(std::string_view json);
    // Counts for a while. {"pending": true}, {"pending": false} if nothing was asked, else once "counts" with
    // what was counted.
    std::string takeCountsJson();
    // The style as it is drawn, with ranges where it leaves them to the clouds.
    std::string drawnStyleJson() const { return jsonOf(drawn_.style); }
    // {"viridis": {"colours": [[r, g, b], …], "isColourBlindSafe": true}, …}, from low values to high.
    static std::string gradientsJson();

    // {"answer": {…}} or {"error": sentence}, of client/survey/measure_json.hpp.
    static std::string measureJson(std::string_view request);
    // Where world positions [[x, y, z], …] are in the present picture: [x, y, view distance] each, in pixels
    // from the canvas's top left; null for what is behind the camera.
    std::string projectJson(std::string_view positions) const;
    // What a polygon on the present picture reaches into (client/core/screen_polygon.hpp); corners [[x, y],
    // …] in pixels from the canvas's top left.
    std::string screenPolygonJson(std::string_view corners) const;

    // Scans of regions (client/core/region_scan.hpp), for the worker that makes something of their points.
    // The metadata of a cloud as in its file; empty if it is not open.
    Bytes metadataOf(CloudId id) const;
    // `json`: {"cloud": id, "region": {…}, "attributes": [indices]}.
    Result<RegionScanId> scanRegion(std::string_view json);
    // The next node that is here: its message (client/web/region_messages.hpp) and bytes; nothing if none is.
    std::optional<std::pair<Bytes, Bytes>> takeRegionNode(RegionScanId id);
    // {"nodesDone", "nodesToDo", "pointsDone", "pointsToDo", "nodesOutside", "chunksToDo", "bytesRead",
    // "hierarchyKnown", "complete", "error": sentence or null}
    std::string regionProgressJson(RegionScanId id) const;
    void endRegionScan(RegionScanId id);

    // Takes arrivals, selects, and draws if the picture changed; true if it drew. An error of the renderer is
    // kept for drawError().
    void load(); // works off what arrived and asks for more, without drawing
    bool frame();
    // See ViewSession.
    void frameTook(double seconds) { session_->frameTook(seconds); }
    void refineAtRest() { session_->refineAtRest(); }
    // Draws the present picture once more, for reading it back.
    void redraw() { drawAgain_ = true; }
    bool settled() const;
    // {"frame":{FrameCounters},"session":{SessionCounters},"gpuBytes":…,"heapBytes":…,
    // "decodesPending":…,"settled":…}
    std::string countersJson() const;
    // What can not be drawn as asked for: ["sentence", …]. What clouds lack is in cloudsJson().
    std::string errorsJson() const;

    // The browser took the context away, and gave it back.
    void contextLost();
    Status contextRestored();

    WorkerDecoder& decoder() { return *decoder_; }

  private:
    Viewer();
    // What the picture answered to pick(): the hit, or the JSON that says that there is none (yet), `name`
    // being what is null then.
    std::variant<PickHit, std::string> takeHit(const char* name);
    nlohmann::json pickedJson(const PickHit& hit, const PointRecord& record) const;
    static std::string jsonOf(const Style& style);
    double aspect() const { return static_cast<double>(width_) / height_; }
    CloudId add(std::unique_ptr<ByteSource> source, const std::string& name, const BoxD& expected = {});
    bool pendingViewIsDue() const { return pendingView_ && !session_->contentBounds().empty(); }
    void applyPendingView();
    void keepCounters();
    double begin(const Camera& destination);

    std::unique_ptr<WorkerDecoder> decoder_; // outlives the session
    std::unique_ptr<ViewSession> session_;
    std::unique_ptr<GlesRenderer> renderer_;
    gles::PointTarget partTarget_;
    Bytes partPixels_;
    bool inParts_ = false, partsBegun_ = false;
    FramePlan drawn_;
    int width_ = 1, height_ = 1;
    std::optional<NamedView> pendingView_ = NamedView::iso; // shown as soon as a cloud is ready
    bool cameraWasSet_ = false; // by the page, since there was no cloud: the first one keeps it
    bool drawAgain_ = false;
    std::optional<Error> drawError_;
    std::optional<PickHit> picked_; // whose values are on their way
    std::optional<ViewCounter> counter_;
    std::optional<CameraTrack> track_;
    std::optional<Flight> flight_;
    Camera flown_; // where the flight had come to
};

} // namespace stipple::web
