// A session over scripted sources, with an inline decoder unless told otherwise, and a clock that goes on by
// a second an update.
#pragma once

#include "client/core/view_session.hpp"
#include "tests/support/scripted_source.hpp"
#include "tests/support/small_cloud.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace stipple::test {

struct SessionFixture {
    std::chrono::steady_clock::time_point now;
    std::unique_ptr<NodeDecoder> decoder;
    std::unique_ptr<ViewSession> session;

    explicit SessionFixture(const SessionLimits& limits = {},
                            std::unique_ptr<NodeDecoder> decodes = makeInlineDecoder())
        : decoder(std::move(decodes)) {
        session = ViewSession::create(*decoder, limits, [this] { return now; });
        session->setViewport(800, 600);
    }
    SessionFixture(const SessionFixture&) = delete;
    SessionFixture& operator=(const SessionFixture&) = delete;

    std::shared_ptr<SourceScript> open(Bytes file) {
        auto script = std::make_shared<SourceScript>();
        script->file = std::move(file);
        session->addCloud(std::make_unique<ScriptedSource>(script), "small");
        return script;
    }

    // Updates until settled; false if that takes more than `most` updates.
    bool settle(int most = 500) {
        for (int i = 0; i < most && !session->settled(); ++i) {
            session->update();
            now += std::chrono::seconds(1);
        }
        return session->settled();
    }

    // Opens, and looks at everything.
    std::shared_ptr<SourceScript> openAndFit(const SmallCloud& cloud) {
        auto script = open(cloud.file);
        look(cloud);
        return script;
    }
    void look(const SmallCloud& cloud, NamedView view = NamedView::top) {
        session->setCamera(namedCamera(view, cloud.metadata.worldBounds(), 800.0 / 600));
    }

    std::uint64_t pointsDrawn() const { return session->plan().counters.pointsDrawn; }
};

inline SessionLimits everything() {
    SessionLimits limits;
    limits.minNodePixels = 1;
    return limits;
}

// Bytes that were asked for more than once.
inline std::uint64_t bytesAskedTwice(const std::vector<ByteRange>& reads) {
    std::vector<ByteRange> sorted = reads;
    std::sort(sorted.begin(), sorted.end(),
              [](const ByteRange& a, const ByteRange& b) { return a.offset < b.offset; });
    std::uint64_t twice = 0, end = 0;
    for (const ByteRange& range : sorted) {
        if (range.offset < end)
            twice += std::min(end, range.end()) - range.offset;
        end = std::max(end, range.end());
    }
    return twice;
}

inline const NodeEntry& nodeOf(const SmallCloud& cloud, const std::string& key) {
    return *std::find_if(cloud.nodes.begin(), cloud.nodes.end(),
                         [&](const NodeEntry& entry) { return entry.key.text() == key; });
}

// 21 nodes, some 3 MB: big enough that most of it lies beyond the first request.
inline const SmallCloud& bigCloud() {
    static SmallCloud cloud = makeSmallCloud({.levels = 3, .pointsPerNode = 20000});
    return cloud;
}
inline const SmallCloud& smallCloud() {
    static SmallCloud cloud = makeSmallCloud();
    return cloud;
}

} // namespace stipple::test
