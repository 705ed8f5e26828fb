#include "converter/synth/scan_block.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::synth {

ScanColumns::ScanColumns(const Schema& schema) {
    namespace n = attribute_names;
    intensity = schema.find(n::intensity);
    returnNumber = schema.find(n::returnNumber);
    numberOfReturns = schema.find(n::numberOfReturns);
    scanDirection = schema.find(n::scanDirectionFlag);
    edge = schema.find(n::edgeOfFlightLine);
    classification = schema.find(n::classification);
    scanAngle = schema.find(n::scanAngle);
    source = schema.find(n::pointSourceId);
    gpsTime = schema.find(n::gpsTime);
    red = schema.find(n::red);
    green = schema.find(n::green);
    blue = schema.find(n::blue);
    normal = {schema.find("NormalX"), schema.find("NormalY"), schema.find("NormalZ")};
}

namespace {

// Eight bits times 257, as LAS 1.4 asks for ("normalised to 16 bits").
std::uint16_t colour16(float value) {
    double level = std::round(std::sqrt(std::clamp(static_cast<double>(value), 0.0, 1.0)) * 255);
    return static_cast<std::uint16_t>(level * 257);
}

} // namespace

PointBatch scanPulses(const Scanner& scanner, const Source& source, std::uint64_t seed, std::uint64_t first,
                      std::uint64_t count, const Schema& schema, const ScanColumns& columns, const Grid& grid,
                      Vec3d origin) {
    PointBatch batch;
    std::size_t capacity = static_cast<std::size_t>(count + count / 2), size = 0;
    batch.resize(schema, capacity);
    std::vector<Return> returns;
    for (std::uint64_t index = first; index < first + count; ++index) {
        Pulse pulse = pulseOf(source, seed, index);
        scanner.measure(source, index, pulse, returns);
        if (size + returns.size() > capacity) {
            capacity += capacity / 2 + 16;
            batch.resize(schema, capacity);
        }
        for (const Return& r : returns) {
            Vec3d steps = grid.toSteps(r.position + origin);
            batch.positions[size] = {std::llround(steps.x), std::llround(steps.y), std::llround(steps.z)};
            double intensity = std::clamp(r.intensity, 0.0, 1.0) * 65535;
            batch.setValue<std::uint16_t>(columns.intensity, size, static_cast<std::uint16_t>(intensity));
            batch.setValue<std::uint8_t>(columns.returnNumber, size, r.number);
            batch.setValue<std::uint8_t>(columns.numberOfReturns, size, r.count);
            batch.setValue<std::uint8_t>(columns.scanDirection, size, pulse.leftToRight ? 1 : 0);
            batch.setValue<std::uint8_t>(columns.edge, size, pulse.lastOfLine ? 1 : 0);
            batch.setValue<std::uint8_t>(columns.classification, size, r.classification);
            batch.setValue<std::int16_t>(
                columns.scanAngle, size,
                static_cast<std::int16_t>(std::lround(pulse.scanAngleDegrees / 0.006)));
            batch.setValue<std::uint16_t>(columns.source, size, source.pointSourceId);
            batch.setValue<double>(columns.gpsTime, size, pulse.time);
            batch.setValue<std::uint16_t>(columns.red, size, colour16(r.colour.r));
            batch.setValue<std::uint16_t>(columns.green, size, colour16(r.colour.g));
            batch.setValue<std::uint16_t>(columns.blue, size, colour16(r.colour.b));
            for (int axis = 0; axis < 3; ++axis)
                if (int column = columns.normal[static_cast<std::size_t>(axis)]; column >= 0)
                    batch.setValue<float>(column, size, static_cast<float>(r.normal[axis]));
            ++size;
        }
    }
    batch.resize(schema, size);
    return batch;
}

void cutBatch(PointBatch& batch, std::size_t size, const Schema& schema, const ScanColumns& columns) {
    if (size >= batch.size())
        return;
    batch.resize(schema, size);
    if (size == 0)
        return;
    auto number = batch.value<std::uint8_t>(columns.returnNumber, size - 1);
    if (number == batch.value<std::uint8_t>(columns.numberOfReturns, size - 1))
        return;
    for (std::size_t i = size - number; i < size; ++i)
        batch.setValue<std::uint8_t>(columns.numberOfReturns, i, number);
}

} // namespace stipple::synth
