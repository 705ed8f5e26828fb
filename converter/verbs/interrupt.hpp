// Ctrl-C as a flag, so that a verb ends in order and leaves nothing half-written.
#pragma once

#include <atomic>

namespace stipple::cli {

// Turns true on the first Ctrl-C (SIGINT) or SIGTERM after this call; a second one ends the program at once.
const std::atomic<bool>* stopOnInterrupt();

} // namespace stipple::cli
