// The cells that points are drawn into (software_points.hpp), in parts: each thread has one of its own, so
// that drawing needs no atomic operations and no core waits for a line of memory that another has just
// written. At the end each pixel takes the smallest cell of all parts, which is the same whichever thread
// drew which point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace stipple {

class CellParts {
  public:
    // For `threads` threads, width × height pixels. Pixels of parts other than the first are empty; of the
    // first they are anything.
    void resize(int width, int height, int threads);

    // At most maxParts, and of partsBytes together: with more threads, some share one.
    std::size_t count() const { return parts_.size(); }
    // Rows from top to bottom, and one cell more, which is 0: points outside the picture go there.
    std::uint64_t* part(std::size_t i) { return parts_[i].data(); }

    // What all parts hold, once gathered.
    const std::uint64_t* cells() const { return parts_.front().data(); }
    std::uint64_t* cells() { return parts_.front().data(); }
    std::size_t pixels() const { return pixels_; }

    void clearRow(int y); // of the first part
    // Of all into the first; leaves the others empty. Again: nothing changes.
    void gatherRow(int y);

  private:
    static constexpr std::size_t maxParts = 8, partsBytes = std::size_t{512} << 20;
    std::size_t width_ = 0, pixels_ = 0;
    std::vector<std::vector<std::uint64_t>> parts_;
};

} // namespace stipple
