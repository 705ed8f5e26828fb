#include "client/survey/symmetric_matrix.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::survey {

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

// Turns rows and columns p and q so that m[p][q] becomes 0, and the columns of v with them.
void rotate(Matrix& m, Matrix& v, std::size_t p, std::size_t q) {
    if (m[p][q] == 0)
        return;
    double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
    double t = (theta >= 0 ? 1.0 : -1.0) / (std::abs(theta) + std::hypot(theta, 1.0));
    double c = 1 / std::hypot(t, 1.0), s = t * c;
    for (std::size_t k = 0; k < 3; ++k) {
        double kp = m[k][p], kq = m[k][q];
        m[k][p] = c * kp - s * kq;
        m[k][q] = s * kp + c * kq;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        double pk = m[p][k], qk = m[q][k];
        m[p][k] = c * pk - s * qk;
        m[q][k] = s * pk + c * qk;
    }
    m[p][q] = m[q][p] = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        double kp = v[k][p], kq = v[k][q];
        v[k][p] = c * kp - s * kq;
        v[k][q] = s * kp + c * kq;
    }
}

} // namespace

Eigenvectors eigenvectors(SymmetricMatrix matrix) {
    Matrix& m = matrix.at;
    Matrix v{};
    for (std::size_t i = 0; i < 3; ++i)
        v[i][i] = 1;
    constexpr int sweeps = 30; // six or so are enough
    for (int sweep = 0; sweep < sweeps && (m[0][1] != 0 || m[0][2] != 0 || m[1][2] != 0); ++sweep) {
        rotate(m, v, 0, 1);
        rotate(m, v, 0, 2);
        rotate(m, v, 1, 2);
    }
    std::array<std::size_t, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return m[a][a] < m[b][b]; });
    Eigenvectors result;
    for (std::size_t i = 0; i < 3; ++i) {
        std::size_t column = order[i];
        result.values[i] = m[column][column];
        result.vectors[i] = normalized({v[0][column], v[1][column], v[2][column]});
    }
    return result;
}

} // namespace stipple::survey
