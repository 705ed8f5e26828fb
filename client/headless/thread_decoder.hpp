// Decodes nodes on threads of its own, for native programs.
#pragma once

#include "client/core/node_decoder.hpp"

#include <memory>

namespace stipple {

// `threads` 0: one per core. Jobs begin in the order in which they came. Thread: decode() and pump() belong
// to one thread, which also gets the answers, inside pump(). The destructor breaks off the jobs that
// have begun; what was not delivered is answered with `cancelled`.
std::unique_ptr<NodeDecoder> makeThreadDecoder(int threads = 0);

} // namespace stipple
