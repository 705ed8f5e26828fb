// Paints the nodes of a session's plans (node_paint.hpp), each once: as long as a node, its attributes and
// the style stay as they are, so does its paint, which its cache entry keeps.
//
// Thread: the session's.
#pragma once

#include "client/core/cloud_loader.hpp"
#include "client/core/counters.hpp"
#include "client/core/node_cache.hpp"
#include "client/core/style.hpp"

#include <memory>

namespace stipple {

class PlanPainter {
  public:
    explicit PlanPainter(SessionCounters& counters) : counters_(counters) {} // outlives this

    // The resolved style of the nodes that follow. A style whose clips can't be computed with clips nothing;
    // ViewSession::setStyle takes none.
    void setStyle(const Style& resolved);

    // Renews `cached.paint` of a resident node where it is not of now. True if it did.
    bool paint(const CloudLoader& cloud, std::uint32_t node, bool exact, CachedNode& cached);

    // Packs the normals of a node, once their blocks are here. True if it did.
    static bool orient(const CloudLoader& cloud, CachedNode& cached);

  private:
    SessionCounters& counters_;
    Style style_;
    Clips clips_;
    std::uint64_t number_ = 0;
};

} // namespace stipple
