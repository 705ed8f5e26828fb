// Sums of products as if computed with twice the digits (Ogita, Rump and Oishi, "Accurate Sum and Dot
// Product", 2005, algorithm Dot2): what cancels in the area of a long, thin parcel does not take its digits
// along.
#pragma once

#include <cmath>

namespace stipple {

class AccurateSum {
  public:
    void add(double value) {
        double sum = sum_ + value;
        double part = sum - sum_;
        lost_ += (sum_ - (sum - part)) + (value - part);
        sum_ = sum;
    }
    void addProduct(double a, double b) {
        double product = a * b;
        add(product);
        lost_ += std::fma(a, b, -product);
    }
    double value() const { return sum_ + lost_; }

  private:
    double sum_ = 0, lost_ = 0;
};

} // namespace stipple
