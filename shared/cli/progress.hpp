// Progress of a long run, on standard error: one line that redraws itself on a terminal, a plain line every
// few seconds otherwise. Thread: any, one at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace stipple::cli {

class Progress {
  public:
    // `quiet` prints nothing at all.
    explicit Progress(bool quiet = false);
    ~Progress();

    // Work so far in `phase` ("scan", "tile", "sample", "pack"), in points; `total` 0 where unknown.
    void update(const std::string& phase, std::uint64_t done, std::uint64_t total);
    // Ends the line. Called by the destructor too.
    void finish();

  private:
    void print(const std::string& text);

    bool quiet_;
    bool terminal_;
    bool lineOpen_ = false;
    std::string phase_;
    std::chrono::steady_clock::time_point phaseStart_, lastPrint_;
};

} // namespace stipple::cli
