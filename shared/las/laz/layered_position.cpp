#include "shared/las/laz/layered_position.hpp"

namespace stipple::las::laz {

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

} // namespace stipple::las::laz
