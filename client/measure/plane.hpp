// One channel of a picture in floating point, and separable filters over it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace stipple::measure {

template <class Real>
struct Plane {
    int width = 0, height = 0;
    std::vector<Real> values; // rows from the top

    Plane() = default;
    Plane(int w, int h)
        : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    Real* row(int y) { return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width); }
    const Real* row(int y) const {
        return values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    }
};

namespace detail {

template <class Real>
Plane<Real> alongRows(const Plane<Real>& plane, std::span<const Real> kernel) {
    int reach = static_cast<int>(kernel.size()) / 2;
    auto width = static_cast<std::size_t>(plane.width);
    Plane<Real> out(plane.width, plane.height);
    std::vector<Real> padded(width + kernel.size() - 1);
    for (int y = 0; y < plane.height; ++y) {
        const Real* in = plane.row(y);
        std::fill_n(padded.begin(), reach, in[0]);
        std::copy_n(in, width, padded.begin() + reach);
        std::fill_n(padded.begin() + reach + plane.width, reach, in[plane.width - 1]);
        Real* sum = out.row(y);
        for (std::size_t k = 0; k < kernel.size(); ++k)
            for (std::size_t x = 0; x < width; ++x)
                sum[x] += kernel[k] * padded[x + k];
    }
    return out;
}

template <class Real>
Plane<Real> alongColumns(const Plane<Real>& plane, std::span<const Real> kernel) {
    int reach = static_cast<int>(kernel.size()) / 2;
    Plane<Real> out(plane.width, plane.height);
    for (int y = 0; y < plane.height; ++y)
        for (int k = -reach; k <= reach; ++k) {
            const Real* in = plane.row(std::clamp(y + k, 0, plane.height - 1));
            Real weight = kernel[static_cast<std::size_t>(k + reach)], *sum = out.row(y);
            for (int x = 0; x < plane.width; ++x)
                sum[x] += weight * in[x];
        }
    return out;
}

} // namespace detail

// Correlation with the product of two kernels of an odd number of weights, the middle one at the pixel
// itself; beyond its edge the picture goes on as it ends.
template <class Real>
Plane<Real> filtered(const Plane<Real>& plane, const std::vector<Real>& rows,
                     const std::vector<Real>& columns) {
    return detail::alongColumns<Real>(detail::alongRows<Real>(plane, rows), columns);
}

} // namespace stipple::measure
