// Counts the bytes a program holds through operator new, so that a test can state a bound on memory.
// Link stipple_allocation_meter; it replaces the global operators. Thread: safe.
#pragma once

#include <cstddef>

namespace stipple::test {

// Largest number of bytes held at once since the last reset, beyond what was held at that moment.
std::size_t allocationPeak();
void resetAllocationPeak();

} // namespace stipple::test
