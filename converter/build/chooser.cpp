#include "converter/build/chooser.hpp"

#include "converter/build/cell_chooser.hpp"
#include "converter/build/disk_chooser.hpp"

namespace stipple {

std::unique_ptr<Chooser> makeChooser(Sampling sampling, const Subtree& subtree, const Spacing& spacing,
                                     std::span<const Borders* const> neighbours, int workers,
                                     bool wantsRepresentatives) {
    switch (sampling) {
    case Sampling::random:
        return std::make_unique<RandomChooser>(subtree, spacing, workers);
    case Sampling::grid:
        return std::make_unique<GridChooser>(subtree, spacing, workers);
    case Sampling::poisson:
        break;
    }
    return std::make_unique<DiskChooser>(subtree, spacing, neighbours, workers, wantsRepresentatives);
}

} // namespace stipple
