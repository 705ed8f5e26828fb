// Symmetric 3 × 3 matrices and their axes.
#pragma once

#include "shared/geometry/vec3.hpp"

#include <array>

namespace stipple::survey {

struct SymmetricMatrix {
    std::array<std::array<double, 3>, 3> at{};

    // Adds v vᵀ.
    void addSquare(Vec3d v) {
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                at[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] += v[row] * v[column];
    }
};

// Values ascending; vectors are units, perpendicular to each other.
struct Eigenvectors {
    std::array<double, 3> values{};
    std::array<Vec3d, 3> vectors{};
};

// By Jacobi's rotations (Golub and Van Loan, "Matrix Computations", §8.5), which keep the digits of small
// values better than closed formulas do.
Eigenvectors eigenvectors(SymmetricMatrix matrix);

} // namespace stipple::survey
