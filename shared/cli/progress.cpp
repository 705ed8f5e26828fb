#include "shared/cli/progress.hpp"

#include <cstdio>
#include <fmt/format.h>
#include <unistd.h>

namespace stipple::cli {

namespace {
constexpr auto terminalInterval = std::chrono::milliseconds(100);
constexpr auto plainInterval = std::chrono::seconds(5);
constexpr auto jsonInterval = std::chrono::seconds(1);
constexpr double leastSeconds = 0.2; // before a rate means anything

// Resident memory of this process (Linux); 0 where that can't be known.
std::uint64_t memoryBytes() {
    std::FILE* file = std::fopen("/proc/self/statm", "r");
    if (file == nullptr)
        return 0;
    unsigned long long all = 0, resident = 0;
    int read = std::fscanf(file, "%llu %llu", &all, &resident);
    std::fclose(file);
    return read == 2 ? resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

std::string bytesText(std::uint64_t bytes) {
    constexpr double gigabyte = 1e9;
    double value = static_cast<double>(bytes);
    return value >= gigabyte ? fmt::format("{:.1f} GB", value / gigabyte)
                             : fmt::format("{:.0f} MB", value / 1e6);
}

std::string durationText(double seconds) {
    auto whole = static_cast<std::uint64_t>(seconds + 0.5);
    return whole >= 3600 ? fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60)
                         : fmt::format("{}:{:02}", whole / 60, whole % 60);
}
} // namespace

Progress::Progress(ProgressStyle style) : style_(style), terminal_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
    finish();
}

void Progress::update(const std::string& phase, std::uint64_t done, std::uint64_t total) {
    if (style_ == ProgressStyle::none)
        return;
    auto now = std::chrono::steady_clock::now();
    bool newPhase = phase != phase_;
    if (newPhase) {
        phase_ = phase;
        phaseStart_ = now;
        phaseFirst_ = done;
    }
    using Milliseconds = std::chrono::milliseconds;
    Milliseconds interval = style_ == ProgressStyle::json ? Milliseconds(jsonInterval)
                            : terminal_                   ? Milliseconds(terminalInterval)
                                                          : Milliseconds(plainInterval);
    bool last = total > 0 && done >= total;
    if (!newPhase && !last && now - lastPrint_ < interval)
        return;
    lastPrint_ = now;
    double seconds = std::chrono::duration<double>(now - phaseStart_).count();
    print(style_ == ProgressStyle::json ? json(phase, done, total, seconds)
                                        : line(phase, done, total, seconds));
}

std::string Progress::line(const std::string& phase, std::uint64_t done, std::uint64_t total,
                           double seconds) const {
    std::string text = fmt::format("{:<7} {:>12} points", phase, done);
    if (total > 0)
        text += fmt::format(" {:5.1f} %", 100.0 * static_cast<double>(done) / static_cast<double>(total));
    if (seconds > leastSeconds && done > phaseFirst_) {
        double rate = static_cast<double>(done - phaseFirst_) / seconds;
        text += fmt::format("  {:.2f} M points/s", rate / 1e6);
        if (total > done)
            text += fmt::format(", {} left", durationText(static_cast<double>(total - done) / rate));
    }
    if (std::uint64_t memory = memoryBytes(); memory > 0)
        text += fmt::format(", {} memory", bytesText(memory));
    if (temporaryBytes > 0)
        text += fmt::format(", {} on disk", bytesText(temporaryBytes));
    if (terminal_ && total > 0) {
        constexpr int width = 30;
        int filled = static_cast<int>(static_cast<double>(width) * static_cast<double>(done) /
                                      static_cast<double>(total));
        text = "[" + std::string(static_cast<std::size_t>(filled), '#') +
               std::string(static_cast<std::size_t>(width - filled), ' ') + "] " + text;
    }
    return text;
}

std::string Progress::json(const std::string& phase, std::uint64_t done, std::uint64_t total,
                           double seconds) const {
    double rate =
        seconds > leastSeconds ? static_cast<double>(done - phaseFirst_) / seconds : 0.0; // 0: not known yet
    std::string text =
        fmt::format(R"({{"phase":"{}","done":{},"total":{},"seconds":{:.3f})", phase, done, total, seconds);
    if (rate > 0) {
        text += fmt::format(R"(,"pointsPerSecond":{:.0f})", rate);
        if (total >= done)
            text += fmt::format(R"(,"remainingSeconds":{:.1f})", static_cast<double>(total - done) / rate);
    }
    return text +
           fmt::format(R"(,"memoryBytes":{},"temporaryBytes":{}}})", memoryBytes(), temporaryBytes.load());
}

void Progress::print(const std::string& text) {
    if (terminal_ && style_ == ProgressStyle::text) {
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
