// Structural similarity: Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error Visibility to
// Structural Similarity", IEEE Transactions on Image Processing 13(4), 2004, eq. 13 with the window of
// §III.C: 11 × 11 Gaussian, σ = 1.5, K1 = 0.01, K2 = 0.03, L = 255, C3 = C2 / 2; the mean over every window
// that lies wholly inside the picture (eq. 17), without scaling it down first.
//
// Pictures in colour are compared by their luma, 0.299 R + 0.587 G + 0.114 B, not rounded.
//
// Checked: against ssim.js 3.5.0 (`ssim: "original"`, grey pictures), to 1e-9 on four pairs
// (tests/oracles/measures.json, `scripts/check_measures.sh` computes them anew); against the closed form for
// constant pictures, (2ab + C1) / (a² + b² + C1); symmetry; 1 for equal pictures.
#pragma once

#include "client/render/image.hpp"

namespace stipple::measure {

inline constexpr int ssimWindow = 11; // no side of a picture may be smaller

// -1..1, 1 for equal pictures. Both have one size.
double ssim(const Image& reference, const Image& picture);

} // namespace stipple::measure
