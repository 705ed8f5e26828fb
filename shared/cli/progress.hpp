// Progress of a long run, on standard error: one line that redraws itself on a terminal, a plain line every
// few seconds otherwise, or JSON, one object a line. Thread: any, one at a time.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

namespace stipple::cli {

enum class ProgressStyle { text, json, none };

class Progress {
  public:
    explicit Progress(ProgressStyle style = ProgressStyle::text);
    ~Progress();

    // Work so far in `phase` ("scan", "tile", "sample", "pack"), in points; `total` 0 where unknown.
    void update(const std::string& phase, std::uint64_t done, std::uint64_t total);
    // Ends the line. Called by the destructor too.
    void finish();

    // Bytes in temporary files, shown where they are not 0; whoever writes them keeps it up to date.
    std::atomic<std::uint64_t> temporaryBytes{0};

  private:
    std::string line(const std::string& phase, std::uint64_t done, std::uint64_t total, double seconds) const;
    std::string json(const std::string& phase, std::uint64_t done, std::uint64_t total, double seconds) const;
    void print(const std::string& text);

    ProgressStyle style_;
    bool terminal_;
    bool lineOpen_ = false;
    std::string phase_;
    std::uint64_t phaseFirst_ = 0; // done when the phase was first heard of
    std::chrono::steady_clock::time_point phaseStart_, lastPrint_;
};

} // namespace stipple::cli
