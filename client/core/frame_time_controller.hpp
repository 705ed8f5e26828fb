// Keeps frames near a wanted time by drawing coarser while the camera moves (Progressive Blue Surfels, Brandt
// et al. 2019, §4.3): a factor on the target spacing of continuous detail; with levels the point budget is
// divided by its square, since so many fewer points have that much more space between them.
//
// After each frame  factor ← factor · (3 + took / wanted) / 4  if took / wanted lies outside [0.9, 1.1],
// between 1 (what the style and the limits ask for) and 16.
#pragma once

namespace stipple {

class FrameTimeController {
  public:
    static constexpr double most = 16;
    static constexpr double leastDeviation = 0.9, mostDeviation = 1.1; // nothing is done between them

    // `took`, `wanted`: seconds; times that are no positive number are passed over. True if the factor
    // changed.
    bool frameTook(double took, double wanted);
    // At rest: as fine as asked for. True if the factor changed.
    bool reset();

    double factor() const { return factor_; }

  private:
    double factor_ = 1;
};

} // namespace stipple
