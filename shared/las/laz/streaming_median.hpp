// The median of about the last five numbers (LASzip's StreamingMedian5): a sorted window whose largest and
// smallest are pushed out in turn, as numbers above and below the median come in.
#pragma once

#include "shared/las/laz/arithmetic_model.hpp"

namespace stipple::las::laz {

class StreamingMedian5 {
  public:
    STIPPLE_LAZ_INLINE std::int32_t get() const { return values_[2]; }

    STIPPLE_LAZ_INLINE void add(std::int32_t v) {
        if (dropsLargest_) {
            if (v < values_[2]) {
                values_[4] = values_[3];
                values_[3] = values_[2];
                if (v < values_[0]) {
                    values_[2] = values_[1];
                    values_[1] = values_[0];
                    values_[0] = v;
                } else if (v < values_[1]) {
                    values_[2] = values_[1];
                    values_[1] = v;
                } else {
                    values_[2] = v;
                }
            } else {
                if (v < values_[3]) {
                    values_[4] = values_[3];
                    values_[3] = v;
                } else {
                    values_[4] = v;
                }
                dropsLargest_ = false;
            }
        } else {
            if (values_[2] < v) {
                values_[0] = values_[1];
                values_[1] = values_[2];
                if (values_[4] < v) {
                    values_[2] = values_[3];
                    values_[3] = values_[4];
                    values_[4] = v;
                } else if (values_[3] < v) {
                    values_[2] = values_[3];
                    values_[3] = v;
                } else {
                    values_[2] = v;
                }
            } else {
                if (values_[1] < v) {
                    values_[0] = values_[1];
                    values_[1] = v;
                } else {
                    values_[0] = v;
                }
                dropsLargest_ = true;
            }
        }
    }

  private:
    std::array<std::int32_t, 5> values_{};
    bool dropsLargest_ = true;
};

} // namespace stipple::las::laz
