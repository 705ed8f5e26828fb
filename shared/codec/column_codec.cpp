#include "shared/codec/column_codec.hpp"

#include "shared/base/text.hpp"
#include "shared/codec/bit_stream.hpp"
#include "shared/codec/integer_planes.hpp"
#include "shared/codec/radix_sort.hpp"
#include "shared/codec/varint.hpp"

#include <algorithm>
#include <vector>

namespace stipple {

namespace {

enum class Method : std::uint8_t {
    constant = 0, // one value
    plain = 1,    // the bytes as they are, one section
    planes = 2,
    ranked = 3, // the distinct values in ascending order, and each point's place among them
};

template <class T>
std::vector<T> component(ByteSpan values, std::size_t components, std::size_t c) {
    std::vector<T> own(values.size() / (sizeof(T) * components));
    for (std::size_t i = 0; i < own.size(); ++i)
        own[i] = loadLe<T>(values.data() + (i * components + c) * sizeof(T));
    return own;
}

// Each value's place among the distinct values in ascending order.
template <class T>
std::vector<std::uint32_t> rankValues(const std::vector<T>& values, std::vector<T>& distinct) {
    auto [low, high] = std::minmax_element(values.begin(), values.end());
    T least = *low;
    std::vector<KeyedIndex> keyed(values.size());
    for (std::uint32_t i = 0; i < keyed.size(); ++i)
        keyed[i] = {static_cast<T>(values[i] - least), i};
    sortByKey(keyed, bitLength(static_cast<T>(*high - least)));
    std::vector<std::uint32_t> ranks(values.size());
    for (std::size_t i = 0; i < keyed.size(); ++i) {
        if (i == 0 || keyed[i].key != keyed[i - 1].key)
            distinct.push_back(static_cast<T>(keyed[i].key + least));
        ranks[keyed[i].index] = static_cast<std::uint32_t>(distinct.size() - 1);
    }
    return ranks;
}

// [varint distinct values] [planes of them] [planes of ranks: u8, u16 or u32, the narrowest that holds them]
template <class T>
void writeRanked(ByteWriter& to, const std::vector<T>& values) {
    std::vector<T> distinct;
    std::vector<std::uint32_t> ranks = rankValues(values, distinct);
    writeVarint(to, distinct.size());
    writePlanes<T>(to, distinct);
    if (distinct.size() <= 1u << 8)
        writePlanes<std::uint8_t>(to, std::vector<std::uint8_t>(ranks.begin(), ranks.end()));
    else if (distinct.size() <= 1u << 16)
        writePlanes<std::uint16_t>(to, std::vector<std::uint16_t>(ranks.begin(), ranks.end()));
    else
        writePlanes<std::uint32_t>(to, ranks);
}

template <class T>
Status readRanked(ByteReader& from, std::span<T> values, const WorkGate* gate) {
    std::uint64_t count = readVarint(from);
    if (!from.ok() || count > values.size())
        return Error{
            ErrorCode::corrupt, say(count, " distinct values of ", values.size(), " points"), {}, {}};
    std::vector<T> distinct(static_cast<std::size_t>(count));
    STIPPLE_CHECK(readPlanes<T>(from, distinct, gate));
    auto readRanks = [&]<class R>(R) -> Status {
        std::vector<R> ranks(values.size());
        STIPPLE_CHECK(readPlanes<R>(from, ranks, gate));
        return inPieces(gate, values.size(), [&](std::size_t first, std::size_t end) -> Status {
            for (std::size_t i = first; i < end; ++i) {
                if (ranks[i] >= distinct.size())
                    return Error{
                        ErrorCode::corrupt, say("a value's rank is past the last distinct value"), {}, {}};
                values[i] = distinct[ranks[i]];
            }
            return {};
        });
    };
    return count <= 1u << 8    ? readRanks(std::uint8_t{})
           : count <= 1u << 16 ? readRanks(std::uint16_t{})
                               : readRanks(std::uint32_t{});
}

template <class T>
void encodeComponent(ByteWriter& to, const std::vector<T>& values) {
    if (std::all_of(values.begin(), values.end(), [&](T value) { return value == values[0]; })) {
        to.write(Method::constant);
        to.write(values.empty() ? T{} : values[0]);
        return;
    }
    ByteWriter best;
    best.write(Method::plain);
    writeSection(best,
                 ByteSpan(reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)),
                 sizeof(T) == 8 ? Effort::fast : Effort::thorough); // wide ones seldom repeat as strings
    auto offer = [&](ByteWriter& other) {
        if (other.size() < best.size())
            best = std::move(other);
    };
    if (8 * best.size() > values.size()) { // under a bit a value nothing else comes near
        ByteWriter planes;
        planes.write(Method::planes);
        writePlanes<T>(planes, values);
        offer(planes);
    }
    if (sizeof(T) >= 4) { // times: several returns share one, and all come from a few short spans
        ByteWriter ranked;
        ranked.write(Method::ranked);
        writeRanked(ranked, values);
        offer(ranked);
    }
    to.writeBytes(best.bytes());
}

template <class T>
Status decodeComponent(ByteReader& from, std::span<T> values, const WorkGate* gate) {
    auto method = from.read<Method>();
    if (!from.ok())
        return Error{ErrorCode::truncated, say("an attribute ends early"), {}, {}};
    switch (method) {
    case Method::constant:
        std::fill(values.begin(), values.end(), from.read<T>());
        if (!from.ok())
            return Error{ErrorCode::truncated, say("a constant ends early"), {}, {}};
        return {};
    case Method::plain:
        return readFullSection(from, {reinterpret_cast<std::uint8_t*>(values.data()), values.size_bytes()});
    case Method::planes:
        return readPlanes<T>(from, values, gate);
    case Method::ranked:
        return readRanked<T>(from, values, gate);
    }
    return Error{ErrorCode::corrupt, say("unknown way to store an attribute"), {}, {}};
}

template <class T>
Result<Bytes> decodeAs(ByteReader& from, std::size_t pointCount, std::size_t components,
                       const WorkGate* gate) {
    Bytes values(pointCount * components * sizeof(T));
    std::vector<T> own(pointCount);
    for (std::size_t c = 0; c < components; ++c) {
        STIPPLE_CHECK(askGate(gate, 0));
        STIPPLE_CHECK(decodeComponent<T>(from, own, gate));
        STIPPLE_CHECK(inPieces(gate, pointCount, [&](std::size_t first, std::size_t end) {
            for (std::size_t i = first; i < end; ++i)
                storeLe(values.data() + (i * components + c) * sizeof(T), own[i]);
        }));
    }
    return values;
}

template <class T>
void encodeAs(ByteWriter& to, ByteSpan values, std::size_t components) {
    for (std::size_t c = 0; c < components; ++c)
        encodeComponent(to, component<T>(values, components, c));
}

} // namespace

// per component: [u8 method] [what the method says]
void encodeColumn(ByteWriter& to, ByteSpan values, std::size_t width, std::size_t components) {
    switch (width) {
    case 1:
        return encodeAs<std::uint8_t>(to, values, components);
    case 2:
        return encodeAs<std::uint16_t>(to, values, components);
    case 4:
        return encodeAs<std::uint32_t>(to, values, components);
    default:
        return encodeAs<std::uint64_t>(to, values, components);
    }
}

Result<Bytes> decodeColumn(ByteReader& from, std::size_t pointCount, std::size_t width,
                           std::size_t components, const WorkGate* gate) {
    switch (width) {
    case 1:
        return decodeAs<std::uint8_t>(from, pointCount, components, gate);
    case 2:
        return decodeAs<std::uint16_t>(from, pointCount, components, gate);
    case 4:
        return decodeAs<std::uint32_t>(from, pointCount, components, gate);
    default:
        return decodeAs<std::uint64_t>(from, pointCount, components, gate);
    }
}

} // namespace stipple
