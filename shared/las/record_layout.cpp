#include "shared/las/record_layout.hpp"

#include <array>

namespace stipple::las {

namespace {

namespace names = attribute_names;

class Builder {
  public:
    explicit Builder(int pointFormat) { layout_.pointFormat = pointFormat; }

    // The next whole-byte field.
    void field(std::string_view name, AttributeType type, std::string_view unit = "", double scale = 1) {
        Attribute attribute;
        attribute.name = name;
        attribute.type = type;
        attribute.unit = unit;
        attribute.scale = scale;
        layout_.fields.push_back({layout_.schema.attributes.size(), at_, attribute.size(), 0, 0});
        at_ += attribute.size();
        layout_.schema.attributes.push_back(std::move(attribute));
    }

    // The next `bits` bits of a byte, lowest first.
    void bits(std::string_view name, int bits) {
        layout_.fields.push_back({layout_.schema.attributes.size(), at_, 1, bit_, bits});
        Attribute attribute;
        attribute.name = name;
        layout_.schema.attributes.push_back(std::move(attribute));
        bit_ += bits;
        if (bit_ == 8) {
            bit_ = 0;
            ++at_;
        }
    }

    RecordLayout finish() {
        layout_.recordLength = at_;
        return std::move(layout_);
    }

  private:
    RecordLayout layout_;
    std::size_t at_ = 12; // after X, Y, Z
    int bit_ = 0;
};

// Bytes 12-19 of formats 0-5 (table 7, table 8).
void addLegacyCore(Builder& to) {
    to.field(names::intensity, AttributeType::u16);
    to.bits(names::returnNumber, 3);
    to.bits(names::numberOfReturns, 3);
    to.bits(names::scanDirectionFlag, 1);
    to.bits(names::edgeOfFlightLine, 1);
    to.bits(names::classification, 5);
    to.bits(names::synthetic, 1);
    to.bits(names::keyPoint, 1);
    to.bits(names::withheld, 1);
    to.field(names::scanAngleRank, AttributeType::i8, "deg");
    to.field(names::userData, AttributeType::u8);
    to.field(names::pointSourceId, AttributeType::u16);
}

// Bytes 12-29 of formats 6-10 (table 14, table 15).
void addCore(Builder& to) {
    to.field(names::intensity, AttributeType::u16);
    to.bits(names::returnNumber, 4);
    to.bits(names::numberOfReturns, 4);
    to.bits(names::synthetic, 1);
    to.bits(names::keyPoint, 1);
    to.bits(names::withheld, 1);
    to.bits(names::overlap, 1);
    to.bits(names::scannerChannel, 2);
    to.bits(names::scanDirectionFlag, 1);
    to.bits(names::edgeOfFlightLine, 1);
    to.field(names::classification, AttributeType::u8);
    to.field(names::userData, AttributeType::u8);
    to.field(names::scanAngle, AttributeType::i16, "deg", 0.006);
    to.field(names::pointSourceId, AttributeType::u16);
    to.field(names::gpsTime, AttributeType::f64, "s");
}

void addColour(Builder& to) {
    to.field(names::red, AttributeType::u16);
    to.field(names::green, AttributeType::u16);
    to.field(names::blue, AttributeType::u16);
}

void addWavePacket(Builder& to) {
    to.field(names::wavePacketDescriptorIndex, AttributeType::u8);
    to.field(names::waveformDataOffset, AttributeType::u64, "byte");
    to.field(names::waveformPacketSize, AttributeType::u32, "byte");
    to.field(names::returnPointWaveformLocation, AttributeType::f32, "ps");
    to.field(names::parametricDx, AttributeType::f32);
    to.field(names::parametricDy, AttributeType::f32);
    to.field(names::parametricDz, AttributeType::f32);
}

constexpr std::array<std::size_t, 11> recordSizes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

bool hasColour(int format) {
    return format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
}
bool hasWavePacket(int format) {
    return format == 4 || format == 5 || format == 9 || format == 10;
}

} // namespace

std::size_t pointRecordSize(int pointFormat) {
    return recordSizes[static_cast<std::size_t>(pointFormat)];
}

int highestPointFormat(int versionMinor) {
    return versionMinor >= 4 ? 10 : versionMinor == 3 ? 5 : versionMinor == 2 ? 3 : 1;
}

RecordLayout baseLayout(int pointFormat) {
    Builder builder(pointFormat);
    if (pointFormat >= 6) {
        addCore(builder);
    } else {
        addLegacyCore(builder);
        if (pointFormat != 0 && pointFormat != 2)
            builder.field(names::gpsTime, AttributeType::f64, "s");
    }
    if (hasColour(pointFormat))
        addColour(builder);
    if (pointFormat == 8 || pointFormat == 10)
        builder.field(names::nir, AttributeType::u16);
    if (hasWavePacket(pointFormat))
        addWavePacket(builder);
    return builder.finish();
}

std::optional<RecordField> findField(const RecordLayout& layout, std::string_view name) {
    int attribute = layout.schema.find(name);
    for (const RecordField& field : layout.fields)
        if (static_cast<int>(field.attribute) == attribute)
            return field;
    return std::nullopt;
}

} // namespace stipple::las
