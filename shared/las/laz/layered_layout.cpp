#include "shared/las/laz/layered_layout.hpp"

#include "shared/las/laz/layered_fields.hpp"
#include "shared/las/laz/layered_gps_time.hpp"
#include "shared/las/laz/layered_position.hpp"

namespace stipple::las::laz {

namespace {

constexpr std::size_t point14Bytes = 30, colourBytes = 6, infraredBytes = 2;

Error unsupported(const std::string& what) {
    return {ErrorCode::unsupported, "the LASzip record describes points that no layered chunk has: " + what,
            "", "is the file damaged? Compress it again"};
}

} // namespace

std::vector<LayerField> LayeredLayout::fields() const {
    std::vector<LayerField> all = {
        {0, 8},
        {HeightLayer::offsetBytes, 4},
        {ClassificationFormat::offsetBytes, 1},
        {FlagsFormat::offsetBytes, 1, 0xCF},
        {IntensityLayer::offsetBytes, 2},
        {ScanAngleFormat::offsetBytes, 2},
        {UserDataFormat::offsetBytes, 1},
        {PointSourceFormat::offsetBytes, 2},
        {GpsTimeLayer::offsetBytes, 8},
    };
    for (const ItemPlace& part : {colour, infrared, wavePacket})
        if (part.sizeBytes != 0)
            all.push_back({part.offsetBytes, part.sizeBytes});
    for (std::size_t i = 0; i < extraBytes.sizeBytes; ++i)
        all.push_back({extraBytes.offsetBytes + i, 1});
    return all;
}

Result<LayeredLayout> layeredLayout(const Items& items) {
    LayeredLayout layout;
    if (items.empty() || items[0].type != ItemType::point14)
        return unsupported("the first item is not POINT14");
    int stage = 0;
    for (const Item& item : items) {
        if (item.version != 3 && item.version != 4)
            return unsupported("an item of version " + std::to_string(item.version));
        // Version 4 of POINT14 tells the others each point's channel.
        const ItemPlace part{layout.recordLength, item.sizeBytes, item.version == 4, items[0].version == 4};
        int itemStage = 0;
        std::size_t expected = item.sizeBytes;
        switch (item.type) {
        case ItemType::point14:
            itemStage = 1;
            expected = point14Bytes;
            break;
        case ItemType::rgb14:
        case ItemType::rgbNir14:
            itemStage = 2;
            expected = colourBytes + (item.type == ItemType::rgbNir14 ? infraredBytes : 0);
            layout.colour = part;
            layout.colour.sizeBytes = colourBytes;
            if (item.type == ItemType::rgbNir14) {
                layout.infrared = part;
                layout.infrared.offsetBytes += colourBytes;
                layout.infrared.sizeBytes = infraredBytes;
            }
            break;
        case ItemType::wavePacket14:
            itemStage = 3;
            expected = WavePacketLayer::sizeBytes;
            layout.wavePacket = part;
            break;
        case ItemType::byte14:
            itemStage = 4;
            layout.extraBytes = part;
            break;
        default:
            return unsupported("an item of type " + std::to_string(static_cast<unsigned>(item.type)));
        }
        if (itemStage <= stage)
            return unsupported("items in another order than the point formats have them");
        if (item.sizeBytes != expected || expected == 0)
            return unsupported("an item of type " + std::to_string(static_cast<unsigned>(item.type)) +
                               " with " + std::to_string(item.sizeBytes) + " bytes");
        stage = itemStage;
        layout.recordLength += item.sizeBytes;
    }
    return layout;
}

} // namespace stipple::las::laz
