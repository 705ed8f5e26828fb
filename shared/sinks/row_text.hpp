// Points as text, for the formats that are: exact decimals of coordinates and attribute values.
#pragma once

#include "shared/sinks/decimal.hpp"
#include "shared/sinks/point_sink.hpp"

#include <string>
#include <vector>

namespace stipple {

// How the values of one attribute become text: as the values they mean, offset + scale × stored, in exact
// decimals; floating point as the shortest text that reads back equal. `attribute` outlives it.
class ValueText {
  public:
    explicit ValueText(const Attribute& attribute);

    // One component, stored at `from`. Nothing for a value that means "no value" (noData).
    void append(std::string& text, const std::uint8_t* from) const;

    std::size_t stride() const { return attribute_.size(); } // of a point
    std::size_t componentSize() const { return attributeTypeSize(attribute_.type); }

  private:
    template <class T>
    bool meansNothing(T value) const;
    template <class T>
    void appendWhole(std::string& text, const std::uint8_t* from) const;
    template <class T>
    void appendReal(std::string& text, const std::uint8_t* from) const;

    const Attribute& attribute_;
    DecimalScale decimal_;
};

// The rows of a table: X, Y, Z, then each attribute's components.
class RowText {
  public:
    explicit RowText(const SinkInput& input); // its metadata outlive this

    // "X", "Y", "Z", "Intensity", "name[0]", "name[1]", …
    std::vector<std::string> columnNames() const;
    // Calls appendValue(text) for each column of a row: it appends the value, or nothing for "no value".
    template <class Each>
    void forEachValue(const PointBatch& batch, std::size_t row, const Each& each) const {
        for (std::size_t axis = 0; axis < 3; ++axis)
            each([&](std::string& text) {
                axes_[axis].append(text, batch.positions[row][static_cast<int>(axis)]);
            });
        for (std::size_t i = 0; i < values_.size(); ++i) {
            const std::uint8_t* from = batch.columns[i].data() + row * values_[i].stride();
            for (std::size_t at = 0; at < values_[i].stride(); at += values_[i].componentSize())
                each([&](std::string& text) { values_[i].append(text, from + at); });
        }
    }
    // About how many bytes a row takes.
    std::size_t expectedRowBytes() const;

  private:
    SinkInput input_;
    std::vector<DecimalScale> axes_;
    std::vector<ValueText> values_;
};

} // namespace stipple
