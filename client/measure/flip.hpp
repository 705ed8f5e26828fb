// FLIP, the error that people see when they flip between two pictures: Andersson, Nilsson, Akenine-Möller,
// Oskarsson, Åström, Fairchild, "FLIP: A Difference Evaluator for Alternating Images", Proc. ACM Computer
// Graphics and Interactive Techniques 3(2), 2020 (the version for low dynamic range).
//
//   colour    sRGB → linear → YyCxCz; each channel filtered by the eye's contrast sensitivity (§4.1.1);
//   clamped to
//             the RGB cube; CIELAB under D65 with Hunt's adjustment; HyAB distance, raised to 0.7, spread
//             over 0..1 so that 0.4 of the largest distance (green to blue) becomes 0.95 (§4.1.2-4.1.3)
//   features  edges and points of the luminance, first and second derivatives of a Gaussian of 0.082° (§4.2)
//   error     colour^(1 - feature), 0..1 a pixel (§4.3); pooled as the mean (§4.4)
//
// Checked: against the authors' own program (NVlabs/flip, python/flip.py of 2024, run in double precision
// with plain two-dimensional filters): the mean of four pairs and of four pairs of constant pictures, to 2e-6
// (tests/oracles/measures.json; its "about" says how they were made); 1 for green against blue; symmetry; 0
// for equal pictures.
#pragma once

#include "client/measure/plane.hpp"
#include "client/render/image.hpp"

#include <numbers>

namespace stipple::measure {

// 0.7 m from a monitor 0.7 m and 3840 pixels wide: the paper's own, 67 pixels a degree.
inline constexpr double flipPixelsPerDegree = 0.7 * 3840 / 0.7 * std::numbers::pi / 180;

// The error at each pixel. Symmetric in the two pictures, which have one size and at least one pixel.
Plane<float> flip(const Image& reference, const Image& picture, double pixelsPerDegree = flipPixelsPerDegree);
double mean(const Plane<float>& errors);
// From black (0) over red to pale yellow (1).
Image errorPicture(const Plane<float>& errors);

} // namespace stipple::measure
