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

PositionDecoder::PositionDecoder(std::uint32_t pointCount, int nodeBits, int strata)
    : pointCount_(pointCount), nodeBits_(nodeBits), strata_(strata), spacing_(8u >> (strata - 1)),
      keys_(strataPrefixPoints(pointCount, strata)) {}

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
        return Error{ErrorCode::truncated, "the bits of the positions end early", {}, {}};
    BitReader bits(stream);
    if (stratum == 0 && tokenCount != tokens.size())
        return Error{ErrorCode::corrupt, "stratum 0 has no token for some points", {}, {}};
    STIPPLE_CHECK(stratum == 0 ? decodeFirst(bits, tokens)
                               : decodeBetween(stratum, bits, tokens, tokenCount));
    if (layout_.lowBits > 0)
        decodeLows(stratum, bits);
    if (!bits.ok())
        return Error{ErrorCode::corrupt, "the positions need more bits than there are", {}, {}};
    decoded_ = stratum + 1;
    return {};
}

Status PositionDecoder::decodeFirst(BitReader& bits, std::span<const std::uint8_t> tokens) {
    choices_.clear();
    std::uint64_t key = 0;
    std::uint64_t lastKey = (std::uint64_t{1} << layout_.keyBits) - 1;
    std::size_t step = 8 / spacing_, at = 0;
    for (std::uint8_t token : tokens) {
        if (token > layout_.keyBits || !bits.ok())
            return Error{ErrorCode::corrupt, "a key difference is wider than the key", {}, {}};
        key += readBelowLeadingOne(bits, token);
        if (key > lastKey)
            return Error{ErrorCode::corrupt, "a key is wider than the node", {}, {}};
        keys_[at] = key;
        at += step;
    }
    return {};
}

Status PositionDecoder::decodeBetween(int stratum, BitReader& bits, std::span<const std::uint8_t> tokens,
                                      std::size_t tokenCount) {
    std::uint64_t lastKey = (std::uint64_t{1} << layout_.keyBits) - 1;
    std::size_t half = stratumFirst(stratum) / spacing_;
    choices_.resize(tokens.size());
    // There is a token for each point at most, so `next` stays inside; whether it used up just the
    // tokens that came is checked at the end.
    std::size_t next = 0;
    std::size_t i = half;
    for (std::size_t j = 0; j < tokens.size(); ++j, i += 2 * half) {
        bool hasUpper = i + half < keys_.size();
        std::uint64_t low = keys_[i - half], high = hasUpper ? keys_[i + half] : lastKey;
        std::uint64_t span = high - low;
        if (span == 0) {
            keys_[i] = low;
            choices_[j] = hasUpper ? NeighbourChoice::mean : NeighbourChoice::lower;
            continue;
        }
        std::uint8_t token = tokens[next++];
        int length = bitLength(span) - token / 2;
        if (length < 0 || !bits.ok())
            return Error{ErrorCode::corrupt, "a key leaves the bracket of its neighbours", {}, {}};
        std::uint64_t distance = readBelowLeadingOne(bits, length);
        if (distance > span)
            return Error{ErrorCode::corrupt, "a key leaves the bracket of its neighbours", {}, {}};
        std::uint64_t below = token % 2 != 0 ? span - distance : distance;
        keys_[i] = low + below;
        choices_[j] = hasUpper ? chooseNeighbour(below, span - below) : NeighbourChoice::lower;
    }
    if (next != tokenCount)
        return Error{ErrorCode::corrupt, "the positions do not use the tokens that there are", {}, {}};
    return {};
}

void PositionDecoder::decodeLows(int stratum, BitReader& bits) {
    std::size_t step = stratumStep(stratum) / spacing_;
    for (std::size_t i = stratumFirst(stratum) / spacing_; i < keys_.size() && bits.ok(); i += step)
        lows_[i] = bits.read(layout_.lowBits);
}

Result<std::vector<Vec3<std::uint32_t>>> PositionDecoder::takePositions() {
    BitPermutation toPacked = packedFromKey(layout_);
    std::vector<Vec3<std::uint32_t>> points(strataPrefixPoints(pointCount_, decoded_));
    std::array<std::uint32_t, 3> largest{};
    for (int stratum = 0; stratum < decoded_; ++stratum)
        place(stratum, toPacked, largest,
              std::span(points).subspan(strataPrefixPoints(pointCount_, stratum),
                                        stratumPoints(pointCount_, stratum)));
    for (std::size_t a = 0; a < 3; ++a)
        if (largest[a] > layout_.extent[a])
            return Error{ErrorCode::corrupt, "a point lies outside the extent that its node states", {}, {}};
    return points;
}

// Coordinates of a stratum's points, in the progressive order.
void PositionDecoder::place(int stratum, const BitPermutation& toPacked,
                            std::array<std::uint32_t, 3>& largest, std::span<Vec3<std::uint32_t>> to) const {
    std::size_t first = stratumFirst(stratum) / spacing_, step = stratumStep(stratum) / spacing_;
    std::array<std::uint64_t, 3> mask{};
    for (std::size_t a = 0; a < 3; ++a)
        mask[a] = (std::uint64_t{1} << layout_.keyBitsOf[a]) - 1;
    int shiftY = layout_.keyBitsOf[0], shiftZ = shiftY + layout_.keyBitsOf[1];
    std::size_t out = 0;
    for (std::uint32_t j : bitReversedOrder(static_cast<std::uint32_t>(to.size()))) {
        std::size_t i = first + j * step;
        std::uint64_t packed = toPacked(keys_[i]);
        std::array<std::uint32_t, 3> q{static_cast<std::uint32_t>(packed & mask[0]),
                                       static_cast<std::uint32_t>((packed >> shiftY) & mask[1]),
                                       static_cast<std::uint32_t>((packed >> shiftZ) & mask[2])};
        if (layout_.lowBits > 0) {
            std::uint64_t low = lows_[i];
            for (std::size_t a = 0; a < 3; ++a) {
                int count = layout_.lowBitsOf[a];
                q[a] = (q[a] << count) | static_cast<std::uint32_t>(low & ((std::uint64_t{1} << count) - 1));
                low >>= count;
            }
        }
        for (std::size_t a = 0; a < 3; ++a) {
            largest[a] = std::max(largest[a], q[a]);
            to[out][static_cast<int>(a)] = layout_.origin[a] + layout_.step[a] * q[a];
        }
        ++out;
    }
}

} // namespace stipple
