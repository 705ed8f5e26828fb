#include "shared/cli/progress.hpp"

#include <cstdio>
#include <fmt/format.h>
#include <unistd.h>

namespace stipple::cli {

namespace {
constexpr auto terminalInterval = std::chrono::milliseconds(100);
constexpr auto plainInterval = std::chrono::seconds(5);
} // namespace

Progress::Progress(bool quiet) : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
    finish();
}

void Progress::update(const std::string& phase, std::uint64_t done, std::uint64_t total) {
    if (quiet_)
        return;
    auto now = std::chrono::steady_clock::now();
    bool newPhase = phase != phase_;
    if (newPhase) {
        phase_ = phase;
        phaseStart_ = now;
    }
    auto interval = terminal_ ? std::chrono::duration_cast<std::chrono::milliseconds>(terminalInterval)
                              : std::chrono::duration_cast<std::chrono::milliseconds>(plainInterval);
    bool last = total > 0 && done >= total;
    if (!newPhase && !last && now - lastPrint_ < interval)
        return;
    lastPrint_ = now;

    double seconds = std::chrono::duration<double>(now - phaseStart_).count();
    std::string text = fmt::format("{:<7} {:>12} points", phase, done);
    if (total > 0)
        text += fmt::format(" {:5.1f} %", 100.0 * static_cast<double>(done) / static_cast<double>(total));
    if (seconds > 0.2)
        text += fmt::format("  {:.2f} M points/s", static_cast<double>(done) / seconds / 1e6);
    if (terminal_ && total > 0) {
        constexpr int width = 30;
        int filled = static_cast<int>(static_cast<double>(width) * static_cast<double>(done) /
                                      static_cast<double>(total));
        text = "[" + std::string(static_cast<std::size_t>(filled), '#') +
               std::string(static_cast<std::size_t>(width - filled), ' ') + "] " + text;
    }
    print(text);
}

void Progress::print(const std::string& text) {
    if (terminal_) {
        std::fprintf(stderr, "\r\033[K%s", text.c_str());
        lineOpen_ = true;
    } else {
        std::fprintf(stderr, "%s\n", text.c_str());
    }
    std::fflush(stderr);
}

void Progress::finish() {
    if (lineOpen_)
        std::fprintf(stderr, "\n");
    lineOpen_ = false;
}

} // namespace stipple::cli
