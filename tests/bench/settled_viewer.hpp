// One cloud as the benches look at it: a session that loads all that a view wants before it is looked at.
// Ends the program, saying why, where something fails.
#pragma once

#include "client/core/view_session.hpp"
#include "shared/base/result.hpp"

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>

namespace stipple {

[[noreturn]] void endBench(const Error& error);

template <class T>
T need(Result<T> result) {
    if (!result.ok())
        endBench(result.error());
    return std::move(*result);
}
inline void need(const Status& status) {
    if (!status.ok())
        endBench(status.error());
}

class SettledViewer {
  public:
    SettledViewer(const std::string& path, int width, int height);
    ~SettledViewer();

    const CloudMetadata& metadata() const { return *metadata_; }
    ViewSession& session() { return *session_; }

    // What is drawn of that view once everything it wants is here; valid until the next call.
    const FramePlan& plan(const Camera& camera, const Style& style, std::uint64_t pointBudget,
                          double minNodePixels);

  private:
    void settle(const std::function<bool()>& done);

    std::string path_;
    std::unique_ptr<NodeDecoder> decoder_;
    std::unique_ptr<ViewSession> session_;
    std::shared_ptr<const CloudMetadata> metadata_;
};

inline constexpr std::uint64_t noBudget = std::uint64_t{1} << 40;

} // namespace stipple
