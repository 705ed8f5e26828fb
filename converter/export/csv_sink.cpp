#include "converter/export/csv_sink.hpp"

#include "converter/export/decimal.hpp"
#include "shared/base/text.hpp"

#include <cmath>
#include <limits>

namespace stipple {

namespace {

std::string quoted(const std::string& name) {
    if (name.find_first_of(",\"\r\n") == std::string::npos)
        return name;
    std::string text = "\"";
    for (char c : name)
        text += c == '"' ? "\"\"" : std::string(1, c);
    return text + "\"";
}

// How the values of an attribute become text.
class ValueText {
  public:
    explicit ValueText(const Attribute& attribute) : attribute_(attribute), decimal_(decimalOf(attribute)) {}

    // One component, stored at `from`.
    void append(std::string& text, const std::uint8_t* from) const {
        switch (attribute_.type) {
        case AttributeType::u8:
            return appendInteger<std::uint8_t>(text, from);
        case AttributeType::i8:
            return appendInteger<std::int8_t>(text, from);
        case AttributeType::u16:
            return appendInteger<std::uint16_t>(text, from);
        case AttributeType::i16:
            return appendInteger<std::int16_t>(text, from);
        case AttributeType::u32:
            return appendInteger<std::uint32_t>(text, from);
        case AttributeType::i32:
            return appendInteger<std::int32_t>(text, from);
        case AttributeType::u64:
            return appendInteger<std::uint64_t>(text, from);
        case AttributeType::i64:
            return appendInteger<std::int64_t>(text, from);
        case AttributeType::f32:
            return appendReal<float>(text, from);
        case AttributeType::f64:
            return appendReal<double>(text, from);
        }
    }

    std::size_t stride() const { return attribute_.size(); }
    std::size_t componentSize() const { return attributeTypeSize(attribute_.type); }

  private:
    static bool isScaled(const Attribute& attribute) { return attribute.scale != 1 || attribute.offset != 0; }
    static DecimalScale decimalOf(const Attribute& attribute) {
        std::size_t bits = std::min<std::size_t>(8 * attributeTypeSize(attribute.type), 63);
        std::int64_t limit = bits == 63 ? std::numeric_limits<std::int64_t>::max() : std::int64_t{1} << bits;
        return DecimalScale(attribute.scale, attribute.offset, -limit, limit);
    }

    template <class T>
    bool meansNothing(T value) const {
        if (!attribute_.noData)
            return false;
        auto number = static_cast<double>(value);
        return number == *attribute_.noData || (std::isnan(number) && std::isnan(*attribute_.noData));
    }

    template <class T>
    void appendInteger(std::string& text, const std::uint8_t* from) const {
        T value = loadLe<T>(from);
        if (meansNothing(value))
            return;
        using Wide = std::conditional_t<std::is_signed_v<T>, std::int64_t, std::uint64_t>;
        if (!isScaled(attribute_))
            return stipple::appendInteger(text, static_cast<Wide>(value));
        if (std::is_same_v<T, std::uint64_t> && static_cast<std::int64_t>(value) < 0) // beyond the decimals
            return appendShortest(text, attribute_.offset + attribute_.scale * static_cast<double>(value));
        decimal_.append(text, static_cast<std::int64_t>(value));
    }

    template <class T>
    void appendReal(std::string& text, const std::uint8_t* from) const {
        T value = loadLe<T>(from);
        if (meansNothing(value))
            return;
        if (isScaled(attribute_))
            return appendShortest(text, attribute_.offset + attribute_.scale * static_cast<double>(value));
        appendShortest(text, value);
    }

    const Attribute& attribute_;
    DecimalScale decimal_;
};

class CsvSink final : public PointSink {
  public:
    CsvSink(std::unique_ptr<ByteSink> to, const SinkInput& input) : to_(std::move(to)), input_(input) {
        const CloudMetadata& metadata = input.metadata;
        BoxI bounds = metadata.bounds;
        if (bounds.empty())
            bounds.extend(Vec3i{});
        for (int axis = 0; axis < 3; ++axis)
            axes_.emplace_back(metadata.grid.scale[axis], metadata.grid.offset[axis], bounds.min[axis],
                               bounds.max[axis]);
        for (std::size_t i = 0; i < input.attributes.size(); ++i)
            values_.emplace_back(input.attribute(i));
    }

    Status writeHeader() {
        std::string header = "X,Y,Z";
        for (std::size_t i = 0; i < input_.attributes.size(); ++i) {
            const Attribute& attribute = input_.attribute(i);
            for (int c = 0; c < attribute.components; ++c)
                header += "," + quoted(attribute.components == 1 ? attribute.name
                                                                 : cat(attribute.name, "[", c, "]"));
        }
        return append(header + "\n");
    }

    Result<EncodedPoints> encode(PointBatch batch) const override {
        constexpr std::size_t bytesPerValue = 10; // about
        std::string text;
        text.reserve(batch.size() * (3 + values_.size()) * bytesPerValue);
        for (std::size_t row = 0; row < batch.size(); ++row) {
            for (int axis = 0; axis < 3; ++axis) {
                if (axis > 0)
                    text += ',';
                axes_[static_cast<std::size_t>(axis)].append(text, batch.positions[row][axis]);
            }
            for (std::size_t i = 0; i < values_.size(); ++i) {
                const std::uint8_t* from = batch.columns[i].data() + row * values_[i].stride();
                for (std::size_t at = 0; at < values_[i].stride(); at += values_[i].componentSize()) {
                    text += ',';
                    values_[i].append(text, from + at);
                }
            }
            text += '\n';
        }
        return EncodedPoints{batch.size(), Bytes(text.begin(), text.end()), {}};
    }

    Status write(EncodedPoints points) override { return to_->append(points.bytes); }
    Status finish() override { return to_->finish(); }

  private:
    Status append(const std::string& text) {
        return to_->append(ByteSpan(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
    }

    std::unique_ptr<ByteSink> to_;
    SinkInput input_;
    std::vector<DecimalScale> axes_;
    std::vector<ValueText> values_;
};

} // namespace

Result<std::unique_ptr<PointSink>> csvSink(std::unique_ptr<ByteSink> to, const SinkInput& input) {
    auto sink = std::make_unique<CsvSink>(std::move(to), input);
    STIPPLE_CHECK(sink->writeHeader());
    return std::unique_ptr<PointSink>(std::move(sink));
}

} // namespace stipple
