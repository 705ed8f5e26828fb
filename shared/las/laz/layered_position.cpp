#include "shared/las/laz/layered_position.hpp"

namespace stipple::las::laz {

namespace {

// The kind of return, by number of returns (row) and return number (column): 0 single, 1 and 2 first and last
// of two, 3 first, 4 between, 5 last of many; the format gives the impossible pairs a kind, too.
constexpr char returnKinds[16][17] = {
    "0123453445555555", "1013333333333333", "2124444444433333", "3345444444444444",
    "4344544444444444", "5344454444444444", "3344445444444444", "4344444544444444",
    "4344444454444444", "5344444445444444", "5344444444544444", "5334444444455444",
    "5334444444455544", "5334444444445554", "5334444444444555", "5334444444444455",
};

unsigned returnLevel(unsigned count, unsigned number) {
    return std::min(count > number ? count - number : number - count, 7u);
}

unsigned evenUpTo(unsigned bits, unsigned most) {
    return bits < most ? bits & ~1u : most;
}

std::int32_t sum(std::int32_t a, std::int32_t b) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}
std::int32_t difference(std::int32_t a, std::int32_t b) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

} // namespace

void PositionLayer::State::begin(const Last&) {
    for (auto& model : changes)
        model.init();
    otherChannel.init();
    returnCounts.reset();
    returnNumbers.reset();
    returnSteps.init();
    xSteps.fill({});
    ySteps.fill({});
    xs.init();
    ys.init();
}

PositionLayer::Last PositionLayer::load(const std::uint8_t* record) {
    Last value;
    value.x = loadLe<std::int32_t>(record);
    value.y = loadLe<std::int32_t>(record + 4);
    value.returnNumber = record[returnsOffsetBytes] & 15u;
    value.returnCount = record[returnsOffsetBytes] >> 4;
    value.scanAngle = loadLe<std::uint16_t>(record + 18);
    value.pointSource = loadLe<std::uint16_t>(record + 20);
    value.gpsTime = loadLe<std::uint64_t>(record + 22);
    return value;
}

void PositionLayer::start(const std::uint8_t* record) {
    Last first = load(record);
    channel_ = channelOf(record);
    channels_.start(channel_, first);
    lastKind_ = (first.returnNumber == 1 ? 1u : 0u) | (first.returnNumber >= first.returnCount ? 2u : 0u);
}

unsigned PositionLayer::changesOf(const Last& now, const Last& last) {
    const unsigned up = (now.returnNumber - last.returnNumber) & 15;
    unsigned changes = up == 0 ? 0 : up == 1 ? 1 : up == 15 ? 2 : 3;
    if (now.returnCount != last.returnCount)
        changes |= returnCountChange;
    if (now.scanAngle != last.scanAngle)
        changes |= PointInfo::scanAngleChange << valueShift;
    if (now.gpsTime != last.gpsTime)
        changes |= PointInfo::gpsTimeChange << valueShift;
    if (now.pointSource != last.pointSource)
        changes |= PointInfo::pointSourceChange << valueShift;
    return changes;
}

template <class Stream>
STIPPLE_LAZ_INLINE PointInfo PositionLayer::codePoint(Stream& stream, typename Stream::Byte* record) {
    unsigned changes = 0, channel = channel_;
    Last now;
    if constexpr (Stream::writing) {
        now = load(record);
        channel = channelOf(record);
        changes = changesOf(now, channels_.lastFor(channel)) | (channel != channel_ ? channelChange : 0);
    }
    // What changed is coded with the state of the channel before.
    State& before = channels_.choose(channel_).state;
    changes = stream.symbol(before.changes[lastKind_], changes);
    const bool otherChannel = changes & channelChange;
    if (otherChannel)
        channel_ = (channel_ + 1 + stream.symbol(before.otherChannel, (channel - channel_ - 1) & 3)) & 3;
    auto [state, last] = channels_.choose(channel_);

    unsigned count = last.returnCount, number = last.returnNumber;
    if (changes & returnCountChange)
        count = stream.symbol(state.returnCounts[count], now.returnCount);
    const bool timeChanged = changes & PointInfo::gpsTimeChange << valueShift;
    if ((changes & 3) == 3)
        number =
            timeChanged
                ? stream.symbol(state.returnNumbers[number], now.returnNumber)
                : (number + 2 + stream.symbol(state.returnSteps, (now.returnNumber - number - 2) & 15)) & 15;
    else
        number = (number + (changes & 1) - (changes >> 1 & 1)) & 15;

    const unsigned single = count == 1;
    const unsigned kind = static_cast<unsigned>(returnKinds[count][number] - '0') << 1 | timeChanged;
    const auto xStep = stream.integer(state.xs, state.xSteps[kind].get(), difference(now.x, last.x), single);
    state.xSteps[kind].add(xStep);
    const unsigned xBits = state.xs.k();
    const auto yStep = stream.integer(state.ys, state.ySteps[kind].get(), difference(now.y, last.y),
                                      single + evenUpTo(xBits, 20));
    state.ySteps[kind].add(yStep);
    const unsigned yBits = state.ys.k();

    if constexpr (Stream::writing) {
        last = now;
    } else {
        last.x = sum(last.x, xStep);
        last.y = sum(last.y, yStep);
        last.returnNumber = number;
        last.returnCount = count;
        storeLe(record, last.x);
        storeLe(record + 4, last.y);
        record[returnsOffsetBytes] = static_cast<std::uint8_t>(count << 4 | number);
        record[flagsOffsetBytes] =
            static_cast<std::uint8_t>((record[flagsOffsetBytes] & 0xCF) | channel_ << 4);
    }
    const bool first = number == 1, final = number >= count;
    lastKind_ = (first ? 1u : 0u) | (final ? 2u : 0u) | (timeChanged ? 4u : 0u);
    return PointInfo(channel_, otherChannel, changes >> valueShift & 7, (first ? 2u : 0u) | (final ? 1u : 0u),
                     returnLevel(count, number), single + evenUpTo((xBits + yBits) / 2, 18));
}

template <class Stream>
void PositionLayer::code(Stream& stream, const PointRun<typename Stream::Byte>& run, PointInfo* infos) {
    Stream local = stream;
    auto* record = run.records;
    for (std::size_t i = 0; i < run.count; ++i, record += run.recordLength) {
        infos[i] = codePoint(local, record);
        if (local.pastEnd()) [[unlikely]]
            break;
    }
    stream = local;
}

template void PositionLayer::code(LayerReader&, const PointRun<std::uint8_t>&, PointInfo*);
template void PositionLayer::code(LayerWriter&, const PointRun<const std::uint8_t>&, PointInfo*);

} // namespace stipple::las::laz
