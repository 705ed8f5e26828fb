#include "tests/bench/streaming_ways.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace stipple::test {

namespace {

std::vector<StreamingWay> allWays(std::uint64_t budget, double spacing) {
    StreamingWay all{"all", {}, {}};
    all.limits.pointBudget = budget;
    all.limits.cacheBytes = 2ull << 30;
    all.style.detail.mode = DetailMode::continuous;
    all.style.detail.spacingPixels = spacing;
    std::vector<StreamingWay> ways{all};
    auto without = [&](const char* name, const auto& change) {
        ways.push_back(all);
        ways.back().name = name;
        change(ways.back());
    };
    without("plain", [](StreamingWay& way) {
        way.style.detail.mode = DetailMode::discrete;
        way.limits.techniques = {false, false, false, false};
        way.limits.skips.unused = false;
        way.style.growsWhileLoading = false;
    });
    without("no growing", [](StreamingWay& way) { way.style.growsWhileLoading = false; });
    without("levels", [](StreamingWay& way) { way.style.detail.mode = DetailMode::discrete; });
    without("whole nodes", [](StreamingWay& way) { way.limits.techniques.prefixes = false; });
    without("all attributes", [](StreamingWay& way) { way.limits.skips.unused = false; });
    without("no merging", [](StreamingWay& way) { way.limits.techniques.merging = false; });
    without("no order by value", [](StreamingWay& way) { way.limits.techniques.byValue = false; });
    without("fixed limits", [](StreamingWay& way) { way.limits.techniques.adaptive = false; });
    return ways;
}

} // namespace

std::vector<StreamingWay> streamingWays(const std::vector<std::string>& names, std::uint64_t budget,
                                        double spacing) {
    std::vector<StreamingWay> known = allWays(budget, spacing), ways;
    for (const std::string& name : names) {
        auto way = std::find_if(known.begin(), known.end(),
                                [&](const StreamingWay& one) { return one.name == name; });
        if (way == known.end())
            need(
                Status(Error{ErrorCode::invalidArgument, cat("there is no way '", name, "'"), "--ways", ""}));
        ways.push_back(*way);
    }
    return ways;
}

NetworkOptions networkOf(const std::string& text, int connections) {
    double megabits = 0, milliseconds = 0;
    int read = 0;
    if (std::sscanf(text.c_str(), "%lfx%lf%n", &megabits, &milliseconds, &read) != 2 ||
        static_cast<std::size_t>(read) != text.size() || megabits <= 0 || milliseconds < 0)
        need(Result<int>(
            Error{ErrorCode::invalidArgument, "a network is MBITxMS, for example 50x20", text, ""}));
    NetworkOptions options;
    options.megabitsPerSecond = megabits;
    options.roundTrip = std::chrono::nanoseconds(static_cast<std::int64_t>(milliseconds * 1e6));
    options.connections = connections;
    return options;
}

std::shared_ptr<const HostedFile> hosted(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    auto file = std::make_shared<HostedFile>();
    file->bytes.assign(std::istreambuf_iterator<char>(stream), {});
    return file;
}

} // namespace stipple::test
