#include "tests/damage/sample_points.hpp"

#include <cmath>
#include <random>

namespace stipple::test {

namespace {

// LAS packs these into a few bits; a value that fits the narrowest point format fits all.
std::uint64_t valueLimit(const Attribute& attribute) {
    if (attribute.name == attribute_names::returnNumber || attribute.name == attribute_names::numberOfReturns)
        return 5;
    if (attribute.name == attribute_names::classification)
        return 31;
    if (attribute.name == attribute_names::scannerChannel)
        return 3;
    for (std::string_view flag :
         {attribute_names::scanDirectionFlag, attribute_names::edgeOfFlightLine, attribute_names::synthetic,
          attribute_names::keyPoint, attribute_names::withheld, attribute_names::overlap})
        if (attribute.name == flag)
            return 1;
    return ~0ull;
}

} // namespace

PointBatch samplePoints(const Schema& schema, std::size_t count, int bits, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    PointBatch batch;
    batch.resize(schema, count);
    auto side = static_cast<double>(std::int64_t{1} << bits);
    for (std::size_t i = 0; i < count; ++i) {
        double x = static_cast<double>(random() % 1000003) / 1000003,
               y = static_cast<double>(random() % 1000003) / 1000003;
        double z = 0.5 + 0.2 * std::sin(9 * x) * std::cos(7 * y);
        batch.positions[i] = {static_cast<std::int64_t>(x * side), static_cast<std::int64_t>(y * side),
                              static_cast<std::int64_t>(z * side)};
    }
    for (std::size_t a = 0; a < schema.attributes.size(); ++a) {
        const Attribute& attribute = schema.attributes[a];
        std::uint64_t limit = valueLimit(attribute);
        std::size_t width = attributeTypeSize(attribute.type);
        for (std::size_t at = 0; at < batch.columns[a].size(); at += width) {
            std::uint64_t bitsOfValue = random();
            if (limit != ~0ull)
                bitsOfValue %= limit + 1;
            if (attribute.type == AttributeType::f64) {
                double value = 1e6 + static_cast<double>(at) * 1e-4;
                std::memcpy(&bitsOfValue, &value, sizeof value);
            }
            std::memcpy(batch.columns[a].data() + at, &bitsOfValue, width);
        }
    }
    return batch;
}

} // namespace stipple::test
