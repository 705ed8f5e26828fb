// Targets, ranges and conditions as clients may send them. Lines of the input: target, Range, If-Match,
// If-None-Match, If-Range, a date; the first byte of the input chooses the size of the file. All of it but
// that byte is read as a request's header, too, in one piece and in two.
#include "server/http/byte_range.hpp"
#include "server/http/preconditions.hpp"
#include "server/http/request_header.hpp"
#include "server/http/target.hpp"
#include "server/site/request_rules.hpp"

#include <array>
#include <cstdlib>

using namespace stipple;
using namespace stipple::server;

namespace {

void require(bool holds) {
    if (!holds)
        std::abort();
}

void checkTarget(std::string_view text) {
    auto target = parseTarget(text);
    if (!target)
        return;
    for (std::size_t i = 0; i < target->segments.size(); ++i) {
        const std::string& segment = target->segments[i];
        require(segment != "." && segment != "..");
        require(segment.find('/') == std::string::npos && segment.find('\0') == std::string::npos);
        require(!segment.empty() || i + 1 == target->segments.size());
        auto again = parseTarget("/" + percentEncoded(segment));
        require(segment.empty() || (again.ok() && again->segments.front() == segment));
    }
}

void checkRanges(std::string_view field, std::uint64_t sizeBytes) {
    ResolvedRanges ranges = resolveRanges(field, sizeBytes);
    require((ranges.kind == RangeAnswerKind::parts) == !ranges.parts.empty());
    require(ranges.parts.size() <= maxRangesInRequest);
    for (std::size_t i = 0; i < ranges.parts.size(); ++i) {
        const ByteRange& part = ranges.parts[i];
        require(part.size > 0 && part.offset < sizeBytes && part.size <= sizeBytes - part.offset);
        for (std::size_t j = 0; j < i; ++j)
            require(part.end() <= ranges.parts[j].offset || ranges.parts[j].end() <= part.offset);
    }
}

void checkHeader(std::string_view bytes, std::size_t split) {
    HeaderScan whole, inTwo;
    HeaderScan::State state = whole.scan(bytes);
    // A piece may be malformed where all of it is, but nothing else.
    if (inTwo.scan(bytes.substr(0, split)) == HeaderScan::State::needsMore)
        require(inTwo.scan(bytes) == state);
    else
        require(state != HeaderScan::State::needsMore);
    if (state != HeaderScan::State::complete)
        return;
    std::string_view header = whole.header(bytes);
    require(header.ends_with("\r\n\r\n") && whole.endBytes() <= bytes.size());
    HttpRequest request;
    if (parseRequestHeader(header, request) != 0)
        return;
    for (const auto& [name, value] : request.fields) {
        require(!name.empty() && name.data() > header.data() && name.data() < header.data() + header.size());
        require(value.find_first_of(std::string_view("\r\n\0", 3)) == std::string_view::npos);
    }
    (void)wantsKeepAlive(request);
    (void)checkRequestRules(request);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0)
        return 0;
    std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
    checkHeader(text, text.size() * data[0] / 256);
    std::array<std::string_view, 6> lines;
    for (std::string_view& line : lines) {
        std::size_t end = text.find('\n');
        line = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    checkTarget(lines[0]);
    constexpr std::array<std::uint64_t, 8> sizes{0,          1,          100,  1 << 20, (1 << 20) + 1,
                                                 1ull << 32, 1ull << 63, ~0ull};
    checkRanges(lines[1], sizes[data[0] % sizes.size()]);

    HttpRequest request{"GET", lines[0], 11, {{"Host", lines[5]}}};
    constexpr std::array<std::string_view, 4> names{"Range", "If-Match", "If-None-Match", "If-Range"};
    for (std::size_t i = 0; i < names.size(); ++i)
        if (!lines[i + 1].empty())
            request.fields.emplace_back(names[i], lines[i + 1]);
    for (std::string_view name : {"If-Modified-Since", "If-Unmodified-Since"})
        request.fields.emplace_back(name, lines[5]);
    Validators validators{"\"a\"", 784111777};
    (void)evaluatePreconditions(request, validators, 1'700'000'000);
    (void)rangeApplies(request, validators, 1'700'000'000);
    (void)checkRequestRules(request);
    return 0;
}
