#include "converter/build/point_sums.hpp"

#include "shared/base/text.hpp"

#include <algorithm>

namespace stipple {

namespace {
// The largest value of a column of uint16, and the smallest.
void extremes(const Schema& schema, const PointBatch& batch, std::string_view name, std::uint16_t& min,
              std::uint16_t& max) {
    int a = schema.find(name);
    if (a < 0)
        return;
    const Attribute& attribute = schema.attributes[static_cast<std::size_t>(a)];
    if (attribute.type != AttributeType::u16 || attribute.components != 1)
        return;
    // Locals: bytes may alias what `min` and `max` refer to, and the loop would not vectorize.
    const std::uint8_t* column = batch.columns[static_cast<std::size_t>(a)].data();
    std::uint16_t low = min, high = max;
    for (std::size_t i = 0; i < batch.size(); ++i) {
        auto value = loadLe<std::uint16_t>(column + i * sizeof(std::uint16_t));
        low = std::min(low, value);
        high = std::max(high, value);
    }
    min = low;
    max = high;
}

ColourExtremes colourExtremes(const Schema& schema, const PointBatch& batch) {
    using namespace attribute_names;
    ColourExtremes result;
    std::uint16_t unused = 0;
    extremes(schema, batch, red, unused, result.rgbMax[0]);
    extremes(schema, batch, green, unused, result.rgbMax[1]);
    extremes(schema, batch, blue, unused, result.rgbMax[2]);
    extremes(schema, batch, intensity, result.intensityMin, result.intensityMax);
    return result;
}

bool isIdentity(const Scan& scan, const ScannedInput& input) {
    if (!input.toCloud.isIdentity() ||
        input.description().schema.attributes.size() != scan.schema.attributes.size())
        return false;
    for (std::size_t a = 0; a < input.attributeSources.size(); ++a)
        if (input.attributeSources[a] != static_cast<int>(a))
            return false;
    return true;
}

void mapBatch(const Scan& scan, const ScannedInput& input, const PointBatch& raw, PointBatch& mapped,
              double& gridError) {
    mapped.resize(scan.schema, raw.size());
    for (std::size_t i = 0; i < mapped.size(); ++i) {
        Vec3i p = raw.positions[i];
        mapped.positions[i] = input.toCloud.toCloud(p);
        if (!input.toCloud.isExact())
            for (int axis = 0; axis < 3; ++axis)
                gridError = std::max(
                    gridError, scan.grid.scale[axis] *
                                   input.toCloud.axes[static_cast<std::size_t>(axis)].errorSteps(p[axis]));
    }
    for (std::size_t a = 0; a < input.attributeSources.size(); ++a) {
        int from = input.attributeSources[a];
        if (from < 0)
            std::fill(mapped.columns[a].begin(), mapped.columns[a].end(), std::uint8_t{0});
        else
            mapped.columns[a] = raw.columns[static_cast<std::size_t>(from)];
    }
}

void saveBox(ByteWriter& to, const BoxI& box) {
    to.write(box.min);
    to.write(box.max);
}
BoxI loadBox(ByteReader& from) {
    BoxI box;
    box.min = from.read<Vec3i>();
    box.max = from.read<Vec3i>();
    return box;
}
} // namespace

void ColourExtremes::extend(const ColourExtremes& other) {
    for (std::size_t i = 0; i < 3; ++i)
        rgbMax[i] = std::max(rgbMax[i], other.rgbMax[i]);
    intensityMin = std::min(intensityMin, other.intensityMin);
    intensityMax = std::max(intensityMax, other.intensityMax);
}

void PointSums::add(const PointSums& other) {
    points += other.points;
    bounds.extend(other.bounds);
    for (std::size_t i = 0; i < inputBounds.size(); ++i)
        inputBounds[i].extend(other.inputBounds[i]);
    hash.add(other.hash);
    for (std::size_t i = 0; i < inputHashes.size(); ++i)
        inputHashes[i].add(other.inputHashes[i]);
    colour.extend(other.colour);
    maxGridError = std::max(maxGridError, other.maxGridError);
    for (std::size_t i = 0; i < reports.size(); ++i)
        reports[i].add(other.reports[i]);
}

ReadReport PointSums::report() const {
    ReadReport sum;
    for (const ReadReport& report : reports)
        sum.add(report);
    return sum;
}

void PointSums::save(ByteWriter& to) const {
    to.write(points);
    saveBox(to, bounds);
    to.write<std::uint64_t>(inputBounds.size());
    for (const BoxI& box : inputBounds)
        saveBox(to, box);
    to.write(hash);
    for (const PointHash& input : inputHashes)
        to.write(input);
    to.write(colour);
    to.write(maxGridError);
    for (const ReadReport& report : reports)
        to.write(report);
}

bool PointSums::load(ByteReader& from) {
    points = from.read<std::uint64_t>();
    bounds = loadBox(from);
    if (from.read<std::uint64_t>() != inputBounds.size())
        return false;
    for (BoxI& box : inputBounds)
        box = loadBox(from);
    hash = from.read<PointHash>();
    for (PointHash& input : inputHashes)
        input = from.read<PointHash>();
    colour = from.read<ColourExtremes>();
    maxGridError = from.read<double>();
    for (ReadReport& report : reports)
        report = from.read<ReadReport>();
    return from.ok();
}

std::vector<std::string> PointSums::warnings(const Scan& scan) const {
    std::vector<std::string> result;
    for (std::size_t i = 0; i < inputBounds.size(); ++i)
        if (auto lie = scan.inputs[i].input->contradiction(inputBounds[i]))
            result.push_back(
                cat(scan.inputs[i].description().path, ": ", *lie, "; the points' bounds are used"));
    if (maxGridError > 0)
        result.push_back(cat("the inputs' grids have no common one; points moved by at most ", maxGridError,
                             " to fit the finest"));
    if (double rounding = report().maxRounding; rounding > 0)
        result.push_back(cat("coordinates were rounded to the cloud's grid, by at most ", rounding));
    for (std::size_t i = 0; i < reports.size(); ++i)
        for (const std::string& text : droppedTexts(reports[i]))
            result.push_back(cat(scan.inputs[i].description().path, ": ", text));
    return result;
}

std::vector<std::string> droppedTexts(const ReadReport& report) {
    std::vector<std::string> texts;
    auto dropped = [&](std::uint64_t count, const char* why) {
        if (count > 0)
            texts.push_back(cat(count, count == 1 ? " point was" : " points were", " dropped: ", why));
    };
    dropped(report.notFinite, "a coordinate is no finite number");
    dropped(report.outOfRange, "a coordinate is farther out than a grid can count");
    dropped(report.invalid, "the file marks them as invalid");
    dropped(report.untransformable, "they can't be brought into the cloud's CRS");
    return texts;
}

const PointBatch& toCloud(const Scan& scan, std::size_t index, const PointBatch& raw, PointBatch& mapped,
                          PointSums& sums) {
    const ScannedInput& input = scan.inputs[index];
    BoxI own;
    for (Vec3i p : raw.positions)
        own.extend(p);
    sums.inputBounds[index].extend(own);
    bool same = isIdentity(scan, input);
    if (!same)
        mapBatch(scan, input, raw, mapped, sums.maxGridError);
    const PointBatch& batch = same ? raw : mapped;
    BoxI bounds = same ? own : BoxI{};
    if (!same)
        for (Vec3i p : batch.positions)
            bounds.extend(p);
    sums.bounds.extend(bounds);
    sums.points += batch.size();
    sums.colour.extend(colourExtremes(scan.schema, batch));
    return batch;
}

} // namespace stipple
