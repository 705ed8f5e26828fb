#include "shared/las/laz/layer_choice.hpp"

#include <algorithm>
#include <utility>

namespace stipple::las::laz {

namespace {

namespace names = attribute_names;

// Return numbers and scanner channel are decoded with X and Y.
constexpr std::pair<std::string_view, std::uint32_t> layerOfName[] = {
    {names::intensity, Layers::intensity},
    {names::synthetic, Layers::flags},
    {names::keyPoint, Layers::flags},
    {names::withheld, Layers::flags},
    {names::overlap, Layers::flags},
    {names::scanDirectionFlag, Layers::flags},
    {names::edgeOfFlightLine, Layers::flags},
    {names::classification, Layers::classification},
    {names::userData, Layers::userData},
    {names::scanAngle, Layers::scanAngle},
    {names::pointSourceId, Layers::pointSource},
    {names::gpsTime, Layers::gpsTime},
    {names::red, Layers::rgb},
    {names::green, Layers::rgb},
    {names::blue, Layers::rgb},
    {names::nir, Layers::nir},
    {names::wavePacketDescriptorIndex, Layers::wavePacket},
    {names::waveformDataOffset, Layers::wavePacket},
    {names::waveformPacketSize, Layers::wavePacket},
    {names::returnPointWaveformLocation, Layers::wavePacket},
    {names::parametricDx, Layers::wavePacket},
    {names::parametricDy, Layers::wavePacket},
    {names::parametricDz, Layers::wavePacket},
};

} // namespace

Layers layersOf(const RecordLayout& layout, std::span<const std::string> attributes) {
    const std::size_t baseSize = pointRecordSize(layout.pointFormat);
    Layers layers;
    layers.fields = Layers::z;
    layers.extraBytes.assign(layout.recordLength - baseSize, false);
    for (const RecordField& field : layout.fields) {
        const std::string& name = layout.schema.attributes[field.attribute].name;
        if (std::find(attributes.begin(), attributes.end(), name) == attributes.end())
            continue;
        if (field.offsetBytes >= baseSize)
            std::fill_n(layers.extraBytes.begin() + static_cast<std::ptrdiff_t>(field.offsetBytes - baseSize),
                        field.sizeBytes, true);
        else
            for (const auto& [layerName, layer] : layerOfName)
                if (name == layerName)
                    layers.fields |= layer;
    }
    return layers;
}

} // namespace stipple::las::laz
