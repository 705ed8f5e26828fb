#include "server/http/byte_range.hpp"

#include "server/http/message.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace stipple::server {

namespace {

constexpr std::uint64_t largest = std::numeric_limits<std::uint64_t>::max();

bool isDigits(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// Digits as a number; one that does not fit is `largest`.
std::uint64_t saturated(std::string_view digits) {
    std::uint64_t value = 0;
    for (char c : digits) {
        auto digit = static_cast<std::uint64_t>(c - '0');
        if (value > (largest - digit) / 10)
            return largest;
        value = value * 10 + digit;
    }
    return value;
}

// Compares digits of any length as numbers.
bool isLess(std::string_view a, std::string_view b) {
    a.remove_prefix(std::min(a.find_first_not_of('0'), a.size()));
    b.remove_prefix(std::min(b.find_first_not_of('0'), b.size()));
    return a.size() != b.size() ? a.size() < b.size() : a < b;
}

// One range-spec. Nothing: malformed. An empty range: well-formed, but no byte of the file lies in it.
std::optional<ByteRange> resolveOne(std::string_view spec, std::uint64_t sizeBytes) {
    std::size_t dash = spec.find('-');
    if (dash == std::string_view::npos)
        return std::nullopt;
    std::string_view first = spec.substr(0, dash), last = spec.substr(dash + 1);
    if (first.empty()) { // suffix-range: the last so many bytes
        if (!isDigits(last))
            return std::nullopt;
        std::uint64_t size = std::min(saturated(last), sizeBytes);
        return ByteRange{sizeBytes - size, size};
    }
    if (!isDigits(first) || (!last.empty() && (!isDigits(last) || isLess(last, first))))
        return std::nullopt;
    std::uint64_t from = saturated(first);
    if (from >= sizeBytes)
        return ByteRange{};
    std::uint64_t through = last.empty() ? largest : saturated(last);
    return ByteRange{from, std::min(through, sizeBytes - 1) - from + 1};
}

bool isNear(const ByteRange& a, const ByteRange& b) { // a starts first; ends are inside the file: no wrap
    return b.offset <= a.end() || b.offset - a.end() < rangeMergeGapBytes;
}

void mergeNear(std::vector<ByteRange>& parts) {
    std::vector<ByteRange> sorted = parts;
    std::sort(sorted.begin(), sorted.end(),
              [](const ByteRange& a, const ByteRange& b) { return a.offset < b.offset; });
    std::vector<ByteRange> merged;
    for (const ByteRange& part : sorted) {
        if (!merged.empty() && isNear(merged.back(), part))
            merged.back().size = std::max(merged.back().end(), part.end()) - merged.back().offset;
        else
            merged.push_back(part);
    }
    if (merged.size() < parts.size())
        parts = std::move(merged);
}

ResolvedRanges meaningless(std::uint64_t sizeBytes) {
    return {sizeBytes <= ignoreBadRangeUpToBytes ? RangeAnswerKind::whole : RangeAnswerKind::refused, {}};
}

} // namespace

ResolvedRanges resolveRanges(std::string_view field, std::uint64_t sizeBytes) {
    if (field.empty())
        return {};
    std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) // "bytes 0-9": no unit at all
        return meaningless(sizeBytes);
    // Units are compared without case (RFC 9110 §14.1); one that is not known is ignored.
    if (!equalIgnoringCase(trimmed(field.substr(0, equals)), "bytes"))
        return {};

    ResolvedRanges resolved{RangeAnswerKind::parts, {}};
    std::size_t count = 0;
    for (std::string_view rest = field.substr(equals + 1); !rest.empty();) {
        std::size_t comma = std::min(rest.find(','), rest.size());
        std::string_view spec = trimmed(rest.substr(0, comma));
        rest.remove_prefix(std::min(comma + 1, rest.size()));
        if (spec.empty())
            continue; // empty list elements are ignored (RFC 9110 §5.6.1.2)
        std::optional<ByteRange> part = resolveOne(spec, sizeBytes);
        if (!part || ++count > maxRangesInRequest)
            return meaningless(sizeBytes);
        if (part->size > 0)
            resolved.parts.push_back(*part);
    }
    if (count == 0)
        return meaningless(sizeBytes);
    if (resolved.parts.empty())
        return {RangeAnswerKind::unsatisfiable, {}};
    mergeNear(resolved.parts);
    return resolved;
}

std::string contentRange(ByteRange part, std::uint64_t sizeBytes) {
    return cat("bytes ", part.offset, "-", part.end() - 1, "/", sizeBytes);
}

std::string unsatisfiedRange(std::uint64_t sizeBytes) {
    return cat("bytes */", sizeBytes);
}

} // namespace stipple::server
