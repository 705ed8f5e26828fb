#include "client/core/resident_node.hpp"

#include <algorithm>
#include <atomic>

namespace stipple {

namespace {

void packPositions(const std::vector<Vec3<std::uint32_t>>& positions, ResidentNode& node) {
    int shift = node.positionShift;
    node.positionWords.reserve(2 * positions.size());
    for (const auto& p : positions) {
        node.positionWords.push_back(packPositionWord0(p.x >> shift, p.y >> shift));
        node.positionWords.push_back(packPositionWord1(p.y >> shift, p.z >> shift));
    }
    if (shift == 0)
        return;
    std::uint32_t mask = (1u << shift) - 1;
    node.positionLowWords.reserve(positions.size());
    for (const auto& p : positions)
        node.positionLowWords.push_back(packPositionLow(p.x & mask, p.y & mask, p.z & mask));
}

} // namespace

std::uint32_t colourWord(std::uint16_t red, std::uint16_t green, std::uint16_t blue, bool is8Bit) {
    // A 16-bit channel is cut to its upper byte: 0xFFFF and 0xFF00 are both full.
    auto byte = [&](std::uint16_t value) -> std::uint32_t {
        return is8Bit ? std::min<std::uint32_t>(value, 255) : value >> 8;
    };
    return byte(red) | byte(green) << 8 | byte(blue) << 16 | 255u << 24;
}

Bytes shownColours(const ResidentNode& node) {
    for (std::int32_t kept : {pictureIntensity, pictureColours})
        if (ByteSpan column = node.columns.column(kept); !column.empty())
            return Bytes(column.begin(), column.end());
    ByteWriter colours;
    for (std::size_t i = 0; node.shownUnit > 0 && i < node.colourWords.size(); ++i)
        for (int channel = 0; channel < 3; ++channel)
            colours.write(
                static_cast<std::uint16_t>((node.colourWords[i] >> (8 * channel) & 255) * node.shownUnit));
    return colours.take();
}

void keepShownColours(ResidentNode& node, const NodePicture& picture) {
    if (picture.colour.size() != 3 * node.colourWords.size())
        return; // intensities are kept as they are
    auto isTimes = [&](std::uint32_t unit) {
        for (std::size_t i = 0; i < picture.colour.size(); ++i)
            if ((node.colourWords[i / 3] >> (8 * (i % 3)) & 255) * unit != picture.colour[i])
                return false;
        return true;
    };
    for (std::uint32_t unit : {257u, 256u, 1u})
        if (isTimes(unit)) {
            node.shownUnit = unit;
            return;
        }
    ByteWriter values;
    for (std::uint16_t value : picture.colour)
        values.write(value);
    node.columns = {node.pointCount, {{pictureColours, 6}}, values.take()};
}

std::uint64_t nextResidentNodeId() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

ResidentNode packNode(const NodeKey& key, int nodeBits, std::uint32_t totalPoints, const NodePicture& picture,
                      PictureColour colour, bool colourIs8Bit) {
    ResidentNode node;
    node.id = nextResidentNodeId();
    node.key = key;
    node.nodeBits = nodeBits;
    node.positionShift = std::max(0, nodeBits - positionWordBits);
    node.pointCount = static_cast<std::uint32_t>(picture.size());
    node.totalPoints = totalPoints;
    packPositions(picture.positions, node);
    if (colour == PictureColour::rgb && picture.colour.size() == 3 * picture.size()) {
        node.colourWords.reserve(picture.size());
        for (std::size_t i = 0; i < picture.colour.size(); i += 3)
            node.colourWords.push_back(
                colourWord(picture.colour[i], picture.colour[i + 1], picture.colour[i + 2], colourIs8Bit));
    } else if (colour == PictureColour::intensity && picture.colour.size() == picture.size()) {
        ByteWriter values;
        for (std::uint16_t value : picture.colour)
            values.write(value);
        node.columns = {node.pointCount, {{pictureIntensity, 2}}, values.take()};
    }
    return node;
}

Vec3<std::uint32_t> positionOf(const ResidentNode& node, std::size_t index) {
    Vec3<std::uint32_t> high =
        unpackPosition(node.positionWords[2 * index], node.positionWords[2 * index + 1]);
    if (node.positionShift == 0)
        return high;
    std::uint32_t low = node.positionLowWords[index];
    int shift = node.positionShift;
    return {high.x << shift | (low & 0x3FFu), high.y << shift | ((low >> 10) & 0x3FFu),
            high.z << shift | ((low >> 20) & 0x3FFu)};
}

} // namespace stipple
