// A cloud to a picture, start to end: opens it, chooses the camera, loads until everything the view wants
// (or the first of it) has arrived, draws once.
#pragma once

#include "client/core/camera.hpp"
#include "client/core/counters.hpp"
#include "client/core/style.hpp"
#include "client/core/view_session.hpp"
#include "client/headless/frame_drawer.hpp"
#include "client/headless/picture_rows.hpp"
#include "client/render/image.hpp"
#include "client/render/pick.hpp"
#include "shared/base/result.hpp"
#include "shared/io/byte_source.hpp"

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stipple::headless {

// When to draw: once everything the view wants has arrived, or as soon as there is anything to see.
enum class Until { complete, first };

struct PictureRequest {
    int width = 1280, height = 720; // pixels, 1..maxPictureSide each (client/render/raster_setup.hpp)
    // "top", "front" or "iso"; or a camera as JSON (client/core/json.hpp), whose absent fields are those of
    // "iso".
    std::string view = "iso";
    std::optional<Projection> projection; // goes before the view's own
    Style style;
    SessionLimits limits;
    Backend backend = Backend::software;
    Until until = Until::complete;
    int threads = 0;                           // of decoding and the software backend; 0: one per core
    std::chrono::milliseconds timeout{60'000}; // for opening and loading together
    const std::atomic<bool>* stop = nullptr;   // once true, opening and loading end with `cancelled`
};

struct Picture {
    Image image;
    Camera camera;
    FrameCounters frame;
    SessionCounters session;
    // What the style asked for that this cloud has not, or this driver can't do, and what was drawn instead.
    std::vector<std::string> limitations;
    std::string renderer;                                     // "software", or the GL driver
    double openSeconds = 0, loadSeconds = 0, drawSeconds = 0; // until ready; until settled; drawing
};

// A point that a picture shows.
struct PickedPoint {
    PointIdentity identity;
    PointRecord record;    // with the value of every attribute
    double pixelsAway = 0; // see PickHit
    double distance = 0;
};

// What can be said against a request before anything is opened: size, view. invalidArgument.
Status checkRequest(const PictureRequest& request);

// One cloud, opened, from which any number of pictures are drawn: what one has loaded and decoded serves the
// next, as far as the cache (limits.cacheBytes) goes. A picture does not depend on those before it. Thread:
// one at a time.
class PictureSession {
  public:
    virtual ~PictureSession() = default;

    // Opens the cloud with the limits, threads, timeout and stop of `request`. Errors: of the source and of
    // the file's bytes; networkFailed or limitExceeded when time runs out; cancelled.
    static Result<std::unique_ptr<PictureSession>> open(std::unique_ptr<ByteSource> source,
                                                        const PictureRequest& request);
    // Which point of the picture that `request` describes is under the pointer, and all that the file says of
    // it; none where no pixel near enough shows a point. By the software renderer, whatever request.backend
    // says. Errors: those of draw().
    virtual Result<std::optional<PickedPoint>> pick(const PictureRequest& request,
                                                    const PickRequest& pointer) = 0;
    // openSeconds is 0. Errors: those of the request, of the source, of the file's bytes (also of single
    // nodes: a picture with holes is no answer), of the GL driver; those of open(). After an error the
    // session is not to be used again.
    virtual Result<Picture> draw(const PictureRequest& request) = 0;
    // The same picture row by row, from the top; Picture::image stays empty. Errors: those of `take`, too.
    virtual Result<Picture> draw(const PictureRequest& request, const TakeRows& take) = 0;
};

// A session for one picture; with `take`, row by row.
Result<Picture> drawPicture(std::unique_ptr<ByteSource> source, const PictureRequest& request,
                            const TakeRows& take = {});

} // namespace stipple::headless
