// What was done and what was skipped. Tests, `render --json`, the page's panel and benchmarks show these
// same numbers.
#pragma once

#include <cstdint>

namespace stipple {

// Of one frame.
struct FrameCounters {
    std::uint64_t cloudsWaiting = 0;       // skipped: not opened, being hidden or out of view
    std::uint64_t nodesKnown = 0;          // in the loaded part of the hierarchy, all clouds
    std::uint64_t nodesVisited = 0;        // taken from the queue of the selection
    std::uint64_t nodesOutsideFrustum = 0; // skipped, with everything below them
    std::uint64_t nodesClipped = 0;        // skipped, with everything below them: wholly clipped away
    std::uint64_t nodesHidden = 0;         // skipped: filters, classes or clip boxes hide all their points
    std::uint64_t nodesTooSmall = 0;       // skipped: projected size under the limit
    std::uint64_t nodesOverBudget = 0;     // skipped: the point budget was used up
    std::uint64_t nodesSelected = 0;       // wanted in the picture
    std::uint64_t nodesWaiting = 0;        // wanted, not here yet
    std::uint64_t nodesDrawn = 0;          // here and drawn
    std::uint64_t nodesDelayed = 0;        // here, but left to the next frame: enough is new in this one
    std::uint64_t nodesOutsidePart = 0; // of a picture in parts, skipped: of each part that they do not reach
    std::uint64_t pointsConsidered = 0; // points of nodes in view and large enough, as far as was looked
    std::uint64_t pointsSelected = 0;   // points of selected nodes
    std::uint64_t pointsDrawn = 0;      // points sent to the rasterizer
    std::uint64_t pointsExpected = 0;   // continuous detail: how many of them are likely to show
    std::uint64_t pointsTooFine = 0;    // of selected nodes, skipped: finer than continuous detail asks for
    std::uint64_t pointsHidden = 0;     // of drawn nodes, by filters, classes or clip boxes
    std::uint64_t nodesExact = 0;       // drawn in their exact colours instead of means
    std::uint64_t chunksWaiting = 0;    // hierarchy chunks wanted, not here yet
    std::uint64_t passesRun = 0;        // full-screen or geometry passes of the renderer
    std::uint64_t passesSkipped = 0;    // passes a setting made unnecessary
    double detailPixels = 0;            // continuous detail: target spacing; 0 with discrete levels
    double coarserForTime = 1;          // factor of the spacing between points that the frame time asks for
    bool complete = false;              // everything the selection wants is drawn
};

// Since the session began.
struct SessionCounters {
    std::uint64_t framesDrawn = 0;
    std::uint64_t framesSkipped = 0; // nothing moved and nothing arrived
    std::uint64_t selectionsRun = 0;
    std::uint64_t selectionsSkipped = 0;
    std::uint64_t requests = 0;       // byte ranges asked for, after merging
    std::uint64_t requestsMerged = 0; // wanted ranges that travelled with a neighbour
    std::uint64_t requestsFailed = 0;
    std::uint64_t requestsCancelled = 0; // nothing of them was wanted any more
    std::uint64_t requestsLetFinish = 0; // nor of these, but they were nearly here
    std::uint64_t requestsRetried = 0;   // after a failure that may pass
    std::uint64_t bytesRequested = 0;
    std::uint64_t bytesReceived = 0;
    std::uint64_t bytesWasted = 0;       // that had come of cancelled requests, as far as sources tell
    std::uint64_t bytesFetchedTwice = 0; // received again: evicted in between, damaged, or read over as a gap
    double networkBytesPerSecond = 0;    // as measured (transfer_estimate.hpp); 0: not yet
    double networkDelaySeconds = 0;
    std::uint64_t cloudsReloaded = 0; // their file was replaced
    std::uint64_t chunksLoaded = 0;
    std::uint64_t nodesDecoded = 0; // decodings; a node refined by a stratum counts again
    std::uint64_t pointsDecoded = 0;
    std::uint64_t nodesEvicted = 0;
    // Further blocks (attributes, exact colours) of nodes whose picture was fetched: all their bytes, and
    // those that were fetched. What styles did not need is the difference.
    std::uint64_t attributeBytesOffered = 0;
    std::uint64_t attributeBytesFetched = 0;
    std::uint64_t nodesPainted = 0;   // colours of a node worked out: it, its attributes or the style changed
    std::uint64_t columnsDropped = 0; // unused attributes of a node let go, to make room or after a while
    std::uint64_t bytesReused = 0;    // decoded without being fetched: they were here, as they came
    std::uint64_t cacheBytes = 0;     // decoded nodes now
    std::uint64_t cacheBytesPeak = 0;
    std::uint64_t compressedBytes = 0; // bytes as they came, now
};

} // namespace stipple
