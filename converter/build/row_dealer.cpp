#include "converter/build/row_dealer.hpp"

namespace stipple {

Status RowDealer::append(RowStore& to, std::size_t rowBytes) {
    Status done;
    for (std::size_t s = 1; s <= cells_.size(); ++s) {
        const std::size_t cell = cells_[s - 1];
        slotOfCell_[cell] = 0;
        std::size_t begin = starts_[s], end = s < cells_.size() ? starts_[s + 1] : indices_.size();
        if (done.ok())
            done = to.append(cell, rows_.data() + begin * rowBytes, end - begin);
    }
    return done;
}

} // namespace stipple
