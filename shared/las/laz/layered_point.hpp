// All layers of a chunk, and one walk over them that decoder and encoder share.
#pragma once

#include "shared/las/laz/layered_fields.hpp"
#include "shared/las/laz/layered_gps_time.hpp"
#include "shared/las/laz/layered_layout.hpp"
#include "shared/las/laz/layered_position.hpp"

namespace stipple::las::laz {

struct LayeredPoint {
    PositionLayer position;
    HeightLayer height;
    ClassificationLayer classification;
    FlagsLayer flags;
    IntensityLayer intensity;
    ScanAngleLayer scanAngle;
    UserDataLayer userData;
    PointSourceLayer pointSource;
    GpsTimeLayer gpsTime;
    ColourLayer colour;
    InfraredLayer infrared;
    WavePacketLayer wavePacket;
    std::vector<ExtraByteLayer> extraBytes;

    // Points that are coded at a time: a run through all layers stays in the cache.
    static constexpr std::size_t runPoints = 512;

    explicit LayeredPoint(const LayeredLayout& layout) {
        colour.place(layout.colour);
        infrared.place(layout.infrared);
        wavePacket.place(layout.wavePacket);
        extraBytes.resize(layout.extraBytes.sizeBytes);
        for (std::size_t i = 0; i < extraBytes.size(); ++i) {
            ItemPlace place = layout.extraBytes;
            place.offsetBytes += i;
            extraBytes[i].place(place);
        }
    }

    // Calls visit(layer index, bit of Layers, layer) for each layer but the first, in the order of the chunk;
    // the bit is 0 for extra bytes.
    template <class Visit>
    void forEachFurther(const LayeredLayout& layout, Visit&& visit) {
        visit(1u, Layers::z, height);
        visit(2u, Layers::classification, classification);
        visit(3u, Layers::flags, flags);
        visit(4u, Layers::intensity, intensity);
        visit(5u, Layers::scanAngle, scanAngle);
        visit(6u, Layers::userData, userData);
        visit(7u, Layers::pointSource, pointSource);
        visit(8u, Layers::gpsTime, gpsTime);
        unsigned index = 9;
        if (layout.colour.sizeBytes != 0)
            visit(index++, Layers::rgb, colour);
        if (layout.infrared.sizeBytes != 0)
            visit(index++, Layers::nir, infrared);
        if (layout.wavePacket.sizeBytes != 0)
            visit(index++, Layers::wavePacket, wavePacket);
        for (auto& layer : extraBytes)
            visit(index++, 0u, layer);
    }
};

} // namespace stipple::las::laz
