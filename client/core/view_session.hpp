// The client without a window: clouds, camera, selection, loading, cache and the frame plan. A program
// (headless, page) sets the camera and calls update() in its loop; when that says so, it draws plan().
//
// Thread: one. Sources and the decoder deliver on this thread.
#pragma once

#include "client/core/camera.hpp"
#include "client/core/counters.hpp"
#include "client/core/frame_plan.hpp"
#include "client/core/loading_techniques.hpp"
#include "client/core/node_decoder.hpp"
#include "client/core/point_record.hpp"
#include "client/core/priority_weights.hpp"
#include "client/core/region_request.hpp"
#include "client/core/skips.hpp"
#include "client/core/style.hpp"
#include "client/core/view_counter.hpp"
#include "shared/io/byte_source.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stipple {

struct SessionLimits {
    std::uint64_t pointBudget = 2'000'000; // points drawn in a frame, all clouds
    double minNodePixels = 60;             // nodes that project smaller are not wanted
    PriorityWeights weights;               // what matters more than its size says (priority_weights.hpp)
    // What a frame may take while the camera moves (frame_time_controller.hpp); 0: as long as it takes.
    double frameMilliseconds = 0;
    // What may be held; what the picture needs is held all the same. Least recently used goes first.
    std::uint64_t cacheBytes = 512ull << 20;      // decoded nodes
    std::uint64_t compressedBytes = 128ull << 20; // of files as they came: to refine nodes, and decode again
    std::uint64_t gpuBytes = 128ull << 20;        // of nodes on the GPU, beside what is drawn
    // New nodes that one frame shows; further ones wait for the next. 0: all at once.
    std::uint64_t uploadBytes = 0;
    // At most; what is right for the network within them is measured (load_limits.hpp).
    int requestsInFlight = 6; // a browser's connections to one host
    std::uint64_t bytesInFlight = 32ull << 20;
    std::uint64_t mergeGapBytes = 256ull << 10;    // ranges this near travel as one request
    std::uint64_t mergedRequestBytes = 4ull << 20; // a merged request's largest size
    Skips skips;
    LoadingTechniques techniques; // not part of the JSON
};

inline constexpr std::size_t maxRecentErrors = 32;

using CloudId = std::uint32_t;

// waiting: nothing was asked for yet, since it is hidden or the place where it is said to be is out of view.
enum class CloudStage { waiting, opening, ready, failed };

struct CloudState {
    CloudId id = 0;
    std::string name;
    CloudStage stage = CloudStage::opening;
    Error error;                                   // failed: why
    std::shared_ptr<const CloudMetadata> metadata; // ready
    BoxD expected; // where it was said to be, in world coordinates; empty: nobody said
    // Ready, but its source fails: why nothing more is asked of it until ViewSession::retry().
    std::optional<Error> interrupted;
    // What failed a moment ago and is tried again by itself: why, and the seconds until the next attempt.
    std::optional<Error> retrying;
    double retrySeconds = 0;
    // Nodes, and pieces of the hierarchy with all nodes in them, that were given up until retry(); why the
    // last of them was.
    std::uint64_t nodesMissing = 0, chunksMissing = 0;
    std::optional<Error> lastLoss;
    int reloads = 0;     // how often its file was replaced by another, which is shown now
    std::string caution; // ByteSource::caution()
    bool visible = true;
};

class ViewSession {
  public:
    // When it is; pauses between attempts depend on it. Tests bring their own.
    using Now = std::function<std::chrono::steady_clock::time_point()>;

    // `decoder` outlives the session.
    static std::unique_ptr<ViewSession> create(NodeDecoder& decoder, const SessionLimits& limits = {},
                                               const Now& now = &std::chrono::steady_clock::now);
    virtual ~ViewSession() = default;

    // Opened as soon as it is visible. With `expected`, the world box that its points are said to lie in (a
    // list of clouds may know it): as soon as that box is in the view, larger than a pixel, the largest
    // first. A scene of hundreds of clouds asks for those alone that it shows. An empty box, or one that is
    // not finite, says nothing.
    virtual CloudId addCloud(std::unique_ptr<ByteSource> source, const std::string& name,
                             const BoxD& expected = {}) = 0;
    virtual void open(CloudId id) = 0;        // a cloud that waits, wherever it is
    virtual void removeCloud(CloudId id) = 0; // cancels its requests, frees its nodes
    virtual void setVisible(CloudId id, bool visible) = 0;
    virtual std::vector<CloudState> clouds() const = 0;
    // As its file has it, for parseMetadata() in another program; empty where the cloud is not ready.
    virtual Bytes metadataBlock(CloudId id) const = 0;
    // World box of the visible clouds, as far as it is known: of those that are not open yet, what they were
    // said to fill. Empty if there are none.
    virtual BoxD contentBounds() const = 0;

    virtual void setViewport(int width, int height) = 0; // pixels, > 0; 1280 × 720 at first
    virtual void setCamera(const Camera& camera) = 0;    // one that is not usable (isUsable) is passed over
    virtual const Camera& camera() const = 0;
    virtual void setStyle(const Style& style) = 0; // one whose clip boxes are not usable is passed over
    virtual const Style& style() const = 0;
    virtual void setLimits(const SessionLimits& limits) = 0;
    virtual const SessionLimits& limits() const = 0;

    // How long the last frame took from its beginning to the next one that could be drawn. Makes the
    // following selections coarser or finer; nothing where limits().frameMilliseconds is 0.
    virtual void frameTook(double seconds) = 0;
    // The camera has come to rest: what was coarser for the sake of time is drawn as fine as asked for.
    virtual void refineAtRest() = 0;

    // Takes arrivals, waiting up to `wait` for the first when something is on its way; selects and requests
    // again if anything changed. True: plan() is new and should be drawn. False: the last picture stands.
    virtual bool update(std::chrono::milliseconds wait = {}) = 0;
    // The first half of update(): all but the plan, which the next update() renews. For programs whose frames
    // are long in coming: what has arrived is worked off, and more is asked for, in between.
    virtual void load(std::chrono::milliseconds wait = {}) = 0;
    virtual const FramePlan& plan() const = 0;
    // Every cloud is open or failed, everything wanted is in plan(), failed for good or belongs to a cloud
    // that is interrupted, nothing is on its way.
    virtual bool settled() const = 0;
    virtual SessionCounters counters() const = 0;

    // From now on the values of these attributes are fetched of what is drawn, after all that the picture
    // wants and without holding it up, and kept; none: no more. Names that a cloud lacks are passed over.
    virtual void watchAttributes(std::vector<std::string> names) = 0;
    // What the present plan shows, to be counted (view_counter.hpp), and points that filters or hidden
    // classes hide; nothing of clouds of which they hide all.
    virtual CountedView countedView() = 0;

    // Asks for everything the file says of a point: reads its node, whatever is here of it. The answer comes
    // with takePointAnswers(), after updates. Errors: invalidArgument for a point that is not there.
    virtual Status askPoint(const PointIdentity& point) = 0;
    // Each answer exactly once; also errors, and `cancelled` if the cloud was closed meanwhile.
    virtual std::vector<PointAnswer> takePointAnswers() = 0;
    virtual bool pointsPending() const = 0;
    // Has all nodes of a region read (region_scan.hpp), after what the picture wants. Errors: invalidArgument
    // for a cloud that is not open, and what of the request can't be.
    virtual Result<RegionScanId> scanRegion(const RegionRequest& request) = 0;
    // Nodes that were read, coarse ones first, at most so many; each once. Nothing where there is no such
    // scan.
    virtual std::vector<RegionNode> takeRegionNodes(RegionScanId id, std::size_t most) = 0;
    // `cancelled` where there is no such scan.
    virtual RegionProgress regionProgress(RegionScanId id) const = 0;
    virtual void endRegionScan(RegionScanId id) = 0; // done with, or not wanted any more
    // A scan has more to do than the last update() did: another should follow soon.
    virtual bool regionsMustGoOn() const = 0;
    // The most recent loading errors (at most maxRecentErrors), newest last, each when it became final: what
    // may pass is tried LoadQueue::maxAttempts times, a block that does not decode twice. A node that failed
    // leaves the others as they are; a file that changed fails its cloud.
    virtual std::vector<Error> recentErrors() const = 0;
    // Why something that is being tried again failed before; nothing if nothing is.
    virtual std::optional<Error> passingFailure() const = 0;
    // Asks again for what could not be had, of one cloud or of all: clouds that could not be opened or were
    // interrupted, nodes that were given up. Camera, style and all that is here stay.
    virtual void retry(std::optional<CloudId> only = std::nullopt) = 0;
};

} // namespace stipple
