// The selection of continuous detail: select() with a target spacing (selection.hpp).
//
// Nodes are visited in the order in which a falling target would let them in (reachPixels), until the target
// that was asked for, or until nodes that are whole at that target use up a budget. Among the nodes seen by
// then the least target within both budgets is found by bisection; each shows what can show of it there.
#pragma once

#include "client/core/selection.hpp"

namespace stipple {

// input.detailPixels > 0.
Selection selectContinuous(const SelectionInput& input);

} // namespace stipple
