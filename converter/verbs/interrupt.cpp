#include "converter/verbs/interrupt.hpp"

#include <csignal>

namespace stipple::cli {

namespace {
std::atomic<bool> interruptedFlag{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

extern "C" void noteInterrupt(int signal) {
    interruptedFlag = true;
    std::signal(signal, SIG_DFL);
}
} // namespace

const std::atomic<bool>* stopOnInterrupt() {
    std::signal(SIGINT, noteInterrupt);
    std::signal(SIGTERM, noteInterrupt);
    return &interruptedFlag;
}

} // namespace stipple::cli
