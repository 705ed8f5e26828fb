// Sums of doubles and of their products without rounding, for the few questions whose answer rounding could
// change: on which side of a line does this point lie? (Shewchuk, "Adaptive Precision Floating-Point
// Arithmetic and Fast Robust Geometric Predicates", 1997, §2: Grow-Expansion, Two-Product.)
//
// Exact as long as no product under- or overflows: for numbers of magnitude 1e-100 to 1e100, and 0.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace stipple {

// Is it among the numbers that all this is exact for?
inline bool isExactlySummable(double number) {
    double size = std::abs(number);
    return size == 0 || (size >= 1e-100 && size <= 1e100);
}

// At most `capacity` summands; a product counts as two.
template <std::size_t capacity>
class ExactSum {
  public:
    void add(double value) {
        for (std::size_t i = 0; i < count_; ++i) {
            double sum = value + parts_[i];
            double virtualPart = sum - value;
            parts_[i] = (value - (sum - virtualPart)) + (parts_[i] - virtualPart); // what the sum lost
            value = sum;
        }
        parts_[count_++] = value;
    }
    void addProduct(double a, double b) {
        double product = a * b;
        add(std::fma(a, b, -product)); // what the product lost
        add(product);
    }
    // To within one unit in the last place.
    double value() const {
        double sum = 0;
        for (std::size_t i = 0; i < count_; ++i)
            sum += parts_[i];
        return sum;
    }
    // 1, 0 or -1.
    int sign() const {
        for (std::size_t i = count_; i-- > 0;)
            if (parts_[i] != 0)
                return parts_[i] > 0 ? 1 : -1;
        return 0;
    }

  private:
    std::array<double, capacity> parts_{}; // they do not overlap, smallest first
    std::size_t count_ = 0;
};

} // namespace stipple
