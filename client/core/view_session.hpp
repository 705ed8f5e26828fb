// The client without a window: clouds, camera, selection, loading, cache and the frame plan. A program
// (headless, page) sets the camera and calls update() in its loop; when that says so, it draws plan().
//
// Thread: one. Sources and the decoder deliver on this thread.
#pragma once

#include "client/core/camera.hpp"
#include "client/core/counters.hpp"
#include "client/core/frame_plan.hpp"
#include "client/core/node_decoder.hpp"
#include "client/core/style.hpp"
#include "shared/io/byte_source.hpp"

#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace stipple {

struct SessionLimits {
    std::uint64_t pointBudget = 2'000'000;   // points drawn in a frame, all clouds
    double minNodePixels = 60;               // nodes that project smaller are not wanted
    std::uint64_t cacheBytes = 512ull << 20; // decoded nodes
    int requestsInFlight = 6;                // a browser's connections to one host
    std::uint64_t bytesInFlight = 8ull << 20;
    std::uint64_t mergeGapBytes = 4096;            // ranges this near travel as one request
    std::uint64_t mergedRequestBytes = 1ull << 20; // a merged request's largest size
};

using CloudId = std::uint32_t;

enum class CloudStage { opening, ready, failed };

struct CloudState {
    CloudId id = 0;
    std::string name;
    CloudStage stage = CloudStage::opening;
    Error error;                                   // failed: why
    std::shared_ptr<const CloudMetadata> metadata; // ready
    bool visible = true;
};

class ViewSession {
  public:
    // `decoder` outlives the session.
    static std::unique_ptr<ViewSession> create(NodeDecoder& decoder, const SessionLimits& limits = {});
    virtual ~ViewSession() = default;

    virtual CloudId addCloud(std::unique_ptr<ByteSource> source, const std::string& name) = 0;
    virtual void removeCloud(CloudId id) = 0; // cancels its requests, frees its nodes
    virtual void setVisible(CloudId id, bool visible) = 0;
    virtual std::vector<CloudState> clouds() const = 0;
    // World box of the visible, ready clouds; empty if there are none.
    virtual BoxD contentBounds() const = 0;

    virtual void setViewport(int width, int height) = 0; // pixels, > 0
    virtual void setCamera(const Camera& camera) = 0;
    virtual const Camera& camera() const = 0;
    virtual void setStyle(const Style& style) = 0;
    virtual const Style& style() const = 0;
    virtual void setLimits(const SessionLimits& limits) = 0;
    virtual const SessionLimits& limits() const = 0;

    // Takes arrivals, waiting up to `wait` for the first when something is on its way; selects and requests
    // again if anything changed. True: plan() is new and should be drawn. False: the last picture stands.
    virtual bool update(std::chrono::milliseconds wait = {}) = 0;
    virtual const FramePlan& plan() const = 0;
    // Everything wanted is in plan(), nothing is on its way.
    virtual bool settled() const = 0;
    virtual SessionCounters counters() const = 0;
    // The most recent loading errors, newest last; a failed node is asked for again a limited number of
    // times.
    virtual std::vector<Error> recentErrors() const = 0;
};

} // namespace stipple
