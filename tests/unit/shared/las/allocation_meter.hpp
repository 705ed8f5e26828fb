// Counts what a test program asks of the heap.
#pragma once

#include <cstddef>

namespace stipple::test {

// Bytes that operator new has been asked for since the program began, whether freed or not.
std::size_t allocatedBytes();

} // namespace stipple::test
