#include "shared/codec/position_codec.hpp"

#include "shared/base/text.hpp"
#include "shared/codec/progressive_order.hpp"
#include "shared/codec/section.hpp"
#include "shared/codec/varint.hpp"

#include <algorithm>

namespace stipple {

namespace {

// A difference d in [0, 2^63) as a token, its bit length, and the bits below its leading one.
void writeDifference(Bytes& tokens, BitWriter& bits, std::uint64_t difference) {
    int length = bitLength(difference);
    tokens.push_back(static_cast<std::uint8_t>(length));
    if (length > 1)
        bits.write(difference, length - 1);
}

// The value with `length` bits whose lower bits follow in `bits`.
std::uint64_t readBelowLeadingOne(BitReader& bits, int length) {
    return length == 0 ? 0 : (std::uint64_t{1} << (length - 1)) | bits.read(length - 1);
}

// Reads keys that lie between two others, one after the other.
struct BetweenReader {
    BitReader bits;
    const std::uint8_t* token;
    bool fits = true;

    std::uint64_t next(std::uint64_t low, std::uint64_t high, NeighbourChoice& choice) {
        std::uint64_t span = high - low;
        choice = NeighbourChoice::mean;
        if (span == 0)
            return low;
        int length = bitLength(span) - *token / 2;
        bool nearHigh = *token++ % 2 != 0;
        fits = length >= 0 && bits.ok();
        std::uint64_t distance = fits ? readBelowLeadingOne(bits, length) : 0;
        fits = fits && distance <= span;
        std::uint64_t below = nearHigh ? span - distance : distance;
        choice = chooseNeighbour(below, span - below);
        return low + below;
    }
};

} // namespace

// [layout, in stratum 0] [section: tokens] [varint: bytes of bits] [bits: per token, then low bits per point]
void encodePositions(ByteWriter& to, const SortedPoints& points, int stratum) {
    if (stratum == 0)
        writeLayout(to, points.layout);
    Bytes tokens;
    BitWriter bits;
    const auto& keys = points.keys;
    std::size_t first = stratumFirst(stratum), step = stratumStep(stratum);
    std::uint64_t lastKey = (std::uint64_t{1} << points.layout.keyBits) - 1;
    for (std::size_t i = first; i < keys.size(); i += step) {
        if (stratum == 0) {
            writeDifference(tokens, bits, i == 0 ? keys[0] : keys[i] - keys[i - step]);
            continue;
        }
        std::uint64_t low = keys[i - first], high = i + first < keys.size() ? keys[i + first] : lastKey;
        if (low == high)
            continue;
        bool nearHigh = high - keys[i] < keys[i] - low;
        std::uint64_t distance = nearHigh ? high - keys[i] : keys[i] - low;
        int length = bitLength(distance);
        tokens.push_back(static_cast<std::uint8_t>(2 * (bitLength(high - low) - 1 - length + 1) + nearHigh));
        if (length > 1)
            bits.write(distance, length - 1);
    }
    if (points.layout.lowBits > 0)
        for (std::size_t i = first; i < keys.size(); i += step)
            bits.write(points.lows[i], points.layout.lowBits);
    writeSection(to, tokens, Effort::literals);
    Bytes stream = bits.take();
    writeVarint(to, stream.size());
    to.writeBytes(stream);
}

std::vector<NeighbourChoice> neighbourChoices(std::span<const std::uint64_t> keys, int stratum) {
    std::vector<NeighbourChoice> choices;
    if (stratum == 0)
        return choices;
    std::size_t half = stratumFirst(stratum);
    choices.reserve(keys.size() / (2 * half) + 1);
    for (std::size_t i = half; i < keys.size(); i += 2 * half)
        choices.push_back(i + half < keys.size()
                              ? chooseNeighbour(keys[i] - keys[i - half], keys[i + half] - keys[i])
                              : NeighbourChoice::lower);
    return choices;
}

PositionDecoder::PositionDecoder(std::uint32_t pointCount, int nodeBits, int strata, const WorkGate* gate)
    : gate_(gate), pointCount_(pointCount), nodeBits_(nodeBits), strata_(strata),
      spacing_(8u >> (strata - 1)), keys_(strataPrefixPoints(pointCount, strata)) {}

Status PositionDecoder::decode(int stratum, ByteReader& from) {
    if (stratum == 0) {
        STIPPLE_TRY(layout, readLayout(from, nodeBits_));
        layout_ = layout;
        if (layout_.lowBits > 0)
            lows_.resize(keys_.size());
    }
    Bytes tokens(stratumPoints(pointCount_, stratum));
    STIPPLE_TRY(tokenCount, readSection(from, tokens));
    ByteSpan stream =
        from.readBytes(static_cast<std::size_t>(std::min<std::uint64_t>(readVarint(from), SIZE_MAX)));
    if (!from.ok())
        return Error{ErrorCode::truncated, say("the bits of the positions end early"), {}, {}};
    PaddedBytes padded(stream);
    BitReader bits(padded);
    if (stratum == 0 && tokenCount != tokens.size())
        return Error{ErrorCode::corrupt, say("stratum 0 has no token for some points"), {}, {}};
    STIPPLE_CHECK(stratum == 0 ? decodeFirst(bits, tokens)
                               : decodeBetween(stratum, bits, tokens, tokenCount));
    if (layout_.lowBits > 0)
        STIPPLE_CHECK(decodeLows(stratum, bits));
    if (!bits.ok())
        return Error{ErrorCode::corrupt, say("the positions need more bits than there are"), {}, {}};
    decoded_ = stratum + 1;
    return {};
}

Status PositionDecoder::decodeFirst(BitReader& stream, std::span<const std::uint8_t> tokens) {
    choices_.clear();
    std::uint64_t before = 0;
    std::uint64_t lastKey = (std::uint64_t{1} << layout_.keyBits) - 1;
    std::size_t step = 8 / spacing_;
    return inPieces(gate_, tokens.size(), [&](std::size_t first, std::size_t end) -> Status {
        BitReader bits = stream; // copies, which stay in registers
        std::uint64_t key = before;
        std::uint64_t* to = keys_.data() + first * step;
        for (std::uint8_t token : tokens.subspan(first, end - first)) {
            if (token > layout_.keyBits || !bits.ok())
                return Error{ErrorCode::corrupt, say("a key difference is wider than the key"), {}, {}};
            key += readBelowLeadingOne(bits, token);
            if (key > lastKey)
                return Error{ErrorCode::corrupt, say("a key is wider than the node"), {}, {}};
            *to = key;
            to += step;
        }
        stream = bits;
        before = key;
        return {};
    });
}

Status PositionDecoder::decodeBetween(int stratum, BitReader& stream, std::span<const std::uint8_t> tokens,
                                      std::size_t tokenCount) {
    std::size_t half = stratumFirst(stratum) / spacing_;
    choices_.resize(tokens.size());
    // There is a token for each point at most, so `token` stays inside; whether just the tokens that came
    // were used is checked at the end.
    BetweenReader reader{stream, tokens.data()};
    std::uint64_t* keys = keys_.data();
    // Points that have both neighbours; one more may have none above.
    std::size_t between = (keys_.size() - 1) / (2 * half);
    STIPPLE_CHECK(inPieces(gate_, between, [&](std::size_t first, std::size_t end) {
        BetweenReader own = reader; // a copy, which stays in registers
        NeighbourChoice* choice = choices_.data() + first;
        std::size_t i = half + 2 * half * first;
        for (std::size_t j = first; j < end && own.fits; ++j, ++choice, i += 2 * half)
            keys[i] = own.next(keys[i - half], keys[i + half], *choice);
        reader = own;
    }));
    if (reader.fits && between < tokens.size()) {
        std::size_t i = half + 2 * half * between;
        keys[i] = reader.next(keys[i - half], (std::uint64_t{1} << layout_.keyBits) - 1, choices_[between]);
        choices_[between] = NeighbourChoice::lower;
    }
    if (!reader.fits)
        return Error{ErrorCode::corrupt, say("a key leaves the bracket of its neighbours"), {}, {}};
    if (reader.token != tokens.data() + tokenCount)
        return Error{ErrorCode::corrupt, say("the positions do not use the tokens that there are"), {}, {}};
    stream = reader.bits;
    return {};
}

Status PositionDecoder::decodeLows(int stratum, BitReader& bits) {
    std::size_t first = stratumFirst(stratum) / spacing_, step = stratumStep(stratum) / spacing_;
    return inPieces(gate_, stratumPoints(pointCount_, stratum), [&](std::size_t begin, std::size_t end) {
        for (std::size_t j = begin; j < end && bits.ok(); ++j)
            lows_[first + j * step] = bits.read(layout_.lowBits);
    });
}

Result<std::vector<Vec3<std::uint32_t>>> PositionDecoder::takePositions() {
    BitPermutation toPacked = packedFromKey(layout_);
    std::vector<Vec3<std::uint32_t>> points(strataPrefixPoints(pointCount_, decoded_));
    bool inside = true;
    for (int stratum = 0; stratum < decoded_; ++stratum) {
        auto part = std::span(points).subspan(strataPrefixPoints(pointCount_, stratum),
                                              stratumPoints(pointCount_, stratum));
        STIPPLE_TRY(placed, layout_.lowBits > 0 ? place<true>(stratum, toPacked, part)
                                                : place<false>(stratum, toPacked, part));
        inside = inside && placed;
    }
    if (!inside)
        return Error{ErrorCode::corrupt, say("a point lies outside the extent that its node states"), {}, {}};
    return points;
}

// Coordinates of a stratum's points, in the progressive order; false if one is larger than the extent.
template <bool hasLows>
Result<bool> PositionDecoder::place(int stratum, const BitPermutation& toPacked,
                                    std::span<Vec3<std::uint32_t>> to) const {
    const KeyLayout layout = layout_; // a copy, so that the loop may keep it in registers
    std::size_t first = stratumFirst(stratum) / spacing_, step = stratumStep(stratum) / spacing_;
    int shiftY = layout.keyBitsOf[0], shiftZ = shiftY + layout.keyBitsOf[1];
    std::uint64_t maskX = (std::uint64_t{1} << layout.keyBitsOf[0]) - 1;
    std::uint64_t maskY = (std::uint64_t{1} << layout.keyBitsOf[1]) - 1;
    Vec3<std::uint32_t> largestOfAll;
    // Keys are unpacked in Morton order, where neighbours share most of their bits and so the tables' lines,
    // and laid close together for the jumps that follow.
    std::vector<std::uint64_t> packedKeys(to.size());
    STIPPLE_CHECK(inPieces(gate_, packedKeys.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t j = begin; j < end; ++j)
            packedKeys[j] = toPacked(keys_[first + j * step]);
    }));
    STIPPLE_TRY(order, bitReversedOrder(static_cast<std::uint32_t>(to.size()), gate_));
    const std::uint32_t* places = order.data();
    STIPPLE_CHECK(inPieces(gate_, to.size(), [&](std::size_t begin, std::size_t end) {
        Vec3<std::uint32_t> largest = largestOfAll;
        for (std::size_t at = begin; at < end; ++at) {
            const std::uint32_t j = places[at];
            std::uint64_t packed = packedKeys[j];
            Vec3<std::uint32_t> q{static_cast<std::uint32_t>(packed & maskX),
                                  static_cast<std::uint32_t>((packed >> shiftY) & maskY),
                                  static_cast<std::uint32_t>(packed >> shiftZ)};
            if constexpr (hasLows) {
                std::uint64_t low = lows_[first + j * step];
                for (int axis = 0; axis < 3; ++axis) {
                    int count = layout.lowBitsOf[static_cast<std::size_t>(axis)];
                    q[axis] = (q[axis] << count) |
                              static_cast<std::uint32_t>(low & ((std::uint64_t{1} << count) - 1));
                    low >>= count;
                }
            }
            largest = {std::max(largest.x, q.x), std::max(largest.y, q.y), std::max(largest.z, q.z)};
            to[at] = {layout.origin[0] + layout.step[0] * q.x, layout.origin[1] + layout.step[1] * q.y,
                      layout.origin[2] + layout.step[2] * q.z};
        }
        largestOfAll = largest;
    }));
    const Vec3<std::uint32_t> largest = largestOfAll;
    return largest.x <= layout.extent[0] && largest.y <= layout.extent[1] && largest.z <= layout.extent[2];
}

} // namespace stipple
