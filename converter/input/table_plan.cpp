#include "converter/input/table_plan.hpp"

#include "converter/input/table_values.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

namespace stipple {

namespace {
namespace names = attribute_names;

struct LasName {
    std::string_view spelling; // lower case, without blanks, '_', '-'
    std::string_view name;
    AttributeType type;
};
constexpr std::array lasNames{
    LasName{"red", names::red, AttributeType::u16},
    LasName{"diffusered", names::red, AttributeType::u16},
    LasName{"r", names::red, AttributeType::u16},
    LasName{"green", names::green, AttributeType::u16},
    LasName{"diffusegreen", names::green, AttributeType::u16},
    LasName{"g", names::green, AttributeType::u16},
    LasName{"blue", names::blue, AttributeType::u16},
    LasName{"diffuseblue", names::blue, AttributeType::u16},
    LasName{"b", names::blue, AttributeType::u16},
    LasName{"nir", names::nir, AttributeType::u16},
    LasName{"infrared", names::nir, AttributeType::u16},
    LasName{"intensity", names::intensity, AttributeType::u16},
    LasName{"i", names::intensity, AttributeType::u16},
    LasName{"classification", names::classification, AttributeType::u8},
    LasName{"class", names::classification, AttributeType::u8},
    LasName{"returnnumber", names::returnNumber, AttributeType::u8},
    LasName{"numberofreturns", names::numberOfReturns, AttributeType::u8},
    LasName{"scandirectionflag", names::scanDirectionFlag, AttributeType::u8},
    LasName{"edgeofflightline", names::edgeOfFlightLine, AttributeType::u8},
    LasName{"scananglerank", names::scanAngleRank, AttributeType::i8},
    LasName{"userdata", names::userData, AttributeType::u8},
    LasName{"pointsourceid", names::pointSourceId, AttributeType::u16},
    LasName{"gpstime", names::gpsTime, AttributeType::f64},
};
// Fields of LAS that are narrower than their type.
struct Width {
    std::string_view name;
    double most;
};
constexpr std::array widths{Width{names::returnNumber, 15}, Width{names::numberOfReturns, 15},
                            Width{names::scanDirectionFlag, 1}, Width{names::edgeOfFlightLine, 1}};

std::string simplified(std::string_view name) {
    std::string text;
    for (char c : name)
        if (c != ' ' && c != '_' && c != '-')
            text += c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
    constexpr std::string_view cloudCompare = "scalar";
    if (name.size() > cloudCompare.size() && text.starts_with(cloudCompare) &&
        name[cloudCompare.size()] == '_')
        text.erase(0, cloudCompare.size());
    return text;
}

const LasName* findLasName(std::string_view name) {
    std::string text = simplified(name);
    for (const LasName& known : lasNames)
        if (known.spelling == text)
            return &known;
    return nullptr;
}

bool isColour(std::string_view name) {
    return name == names::red || name == names::green || name == names::blue;
}

// The smallest type of integers, or f64.
AttributeType typeOfText(const FieldRange& range) {
    if (!range.whole)
        return AttributeType::f64;
    using enum AttributeType;
    for (AttributeType type : {u8, i8, u16, i16, u32, i32, u64, i64}) {
        IntegerLimits limits = integerLimits(type);
        if (range.minWhole >= limits.min && range.maxWhole <= limits.max)
            return type;
    }
    return AttributeType::f64;
}

// Every value of the column is one of the LAS field.
bool fitsExactly(const LasName& las, const FieldRange& range) {
    if (!isInteger(las.type))
        return true; // GPS time: any number
    IntegerLimits limits = integerLimits(las.type);
    double most = static_cast<double>(limits.max);
    for (const Width& width : widths)
        if (width.name == las.name)
            most = width.most;
    return range.isWholeWithin(static_cast<double>(limits.min), most);
}

// Numbers from 0 to 1, not integers by type or by how they are written.
bool isUnit(const TableField& field, const FieldRange& range) {
    bool canBe = field.type ? !isInteger(*field.type) : range.fractional;
    return canBe && range.any && range.isWithin(0, 1);
}

class Planner {
  public:
    Planner(const Table& table, const std::vector<FieldRange>& ranges) : table_(table), ranges_(ranges) {}

    TablePlan plan() {
        decideColours();
        for (std::size_t f = 0; f < table_.fields.size(); ++f)
            if (isAttribute(f))
                addField(f);
        if (!unitNames_.empty())
            plan_.warnings.push_back(cat(unitNames_, ": numbers from 0 to 1 became round(65535 x number)"));
        return std::move(plan_);
    }

  private:
    bool isAttribute(std::size_t f) const {
        return std::find(table_.position.begin(), table_.position.end(), f) == table_.position.end() &&
               table_.fields[f].meaning != TableField::Meaning::leftOut;
    }

    void addField(std::size_t f) {
        using Meaning = TableField::Meaning;
        const TableField& field = table_.fields[f];
        const FieldRange& range = ranges_[f];
        if (field.meaning == Meaning::packedRgb || field.meaning == Meaning::packedRgba)
            return addPacked(f);
        const LasName* las = field.components == 1 ? findLasName(field.name) : nullptr;
        if (!las || plan_.schema.find(las->name) >= 0)
            return addAsItIs(f);
        if (field.meaning == Meaning::signedIntensity && range.isWholeWithin(-2048, 2047)) {
            plan_.warnings.push_back("intensities from -2048 to 2047 became 0 to 4095");
            return add(f, las->name, las->type, FieldStep::How::shifted);
        }
        if (isColour(las->name))
            return addColour(f, *las);
        if (las->name == names::intensity && isUnit(field, range))
            return addUnit(f, *las);
        if (fitsExactly(*las, range))
            return add(f, las->name, las->type, FieldStep::How::value);
        addAsItIs(f);
        plan_.warnings.push_back(cat("not all values of ", field.name, " are ", attributeTypeName(las->type),
                                     ", so it is kept as ", plan_.schema.attributes.back().name, " (",
                                     attributeTypeName(plan_.schema.attributes.back().type), ")"));
    }

    // The columns of red, green and blue are read alike.
    void decideColours() {
        bool any = false, unit = true, whole = true;
        double most = 0;
        for (std::size_t f = 0; f < table_.fields.size(); ++f) {
            const TableField& field = table_.fields[f];
            const LasName* las = field.components == 1 ? findLasName(field.name) : nullptr;
            if (!las || !isColour(las->name) || !isAttribute(f))
                continue;
            const FieldRange& range = ranges_[f];
            any = any || range.any;
            bool canBeUnit = field.type ? !isInteger(*field.type) : true;
            unit = unit && canBeUnit && range.isWithin(0, 1);
            fractional_ = fractional_ || range.fractional || (field.type && !isInteger(*field.type));
            whole = whole && range.isWholeWithin(0, 65535);
            most = std::max(most, range.max);
        }
        coloursAreUnit_ = any && unit && fractional_;
        coloursFit_ = whole;
    }

    void addColour(std::size_t f, const LasName& las) {
        if (coloursAreUnit_)
            return addUnit(f, las);
        if (coloursFit_)
            return add(f, las.name, las.type, FieldStep::How::value);
        addAsItIs(f);
        if (las.name == names::red)
            plan_.warnings.push_back("the colours are neither integers from 0 to 65535 nor numbers from 0 to "
                                     "1, so they are kept as attributes and not shown");
    }

    void addUnit(std::size_t f, const LasName& las) {
        unitNames_ += cat(unitNames_.empty() ? "" : ", ", table_.fields[f].name);
        add(f, las.name, las.type, FieldStep::How::unit);
    }

    // A packed word of colour: 0x00RRGGBB.
    void addPacked(std::size_t f) {
        const bool hasAlpha = table_.fields[f].meaning == TableField::Meaning::packedRgba;
        if (plan_.schema.find(names::red) >= 0 || plan_.schema.find(names::green) >= 0 ||
            plan_.schema.find(names::blue) >= 0)
            return addAsItIs(f);
        add(f, names::red, AttributeType::u16, FieldStep::How::byte, 2);
        add(f, names::green, AttributeType::u16, FieldStep::How::byte, 1);
        add(f, names::blue, AttributeType::u16, FieldStep::How::byte, 0);
        if (hasAlpha)
            add(f, "alpha", AttributeType::u8, FieldStep::How::byte, 3);
    }

    void addAsItIs(std::size_t f) {
        const TableField& field = table_.fields[f];
        AttributeType type = field.type ? *field.type : typeOfText(ranges_[f]);
        bool changes = field.isText;
        add(f, field.name, type, changes ? FieldStep::How::value : FieldStep::How::copy);
        plan_.schema.attributes.back().components = field.components;
    }

    void add(std::size_t f, std::string_view name, AttributeType type, FieldStep::How how, int index = 0) {
        Attribute attribute;
        attribute.name = name.empty() ? std::string("unnamed") : std::string(name);
        attribute.type = type;
        for (int n = 2; plan_.schema.find(attribute.name) >= 0; ++n)
            attribute.name = cat(name.empty() ? std::string_view("unnamed") : name, " (", n, ")");
        if (attribute.name == names::gpsTime)
            attribute.unit = "s";
        plan_.steps.push_back({f, plan_.schema.attributes.size(), how, index});
        plan_.schema.attributes.push_back(std::move(attribute));
    }

    const Table& table_;
    const std::vector<FieldRange>& ranges_;
    TablePlan plan_;
    std::string unitNames_;
    bool coloursAreUnit_ = false, coloursFit_ = false, fractional_ = false;
};

template <class T>
void convertValues(const TableField& field, const FieldStep& step, const Rows& rows, std::uint8_t* to) {
    const std::uint8_t* from = rows.columns[step.field].data();
    const std::size_t count = rows.count * static_cast<std::size_t>(field.components);
    visitRows(field, [&](auto zero) {
        using From = decltype(zero);
        for (std::size_t i = 0; i < count; ++i)
            storeLe(to + i * sizeof(T), convertValue<T>(loadLe<From>(from + i * sizeof(From))));
    });
}

std::uint16_t toUnit(double value) {
    constexpr double most = 65535;
    return convertValue<std::uint16_t>(std::floor(most * value + 0.5));
}

void convertNumbers(const TableField& field, const FieldStep& step, const Rows& rows, std::uint8_t* to) {
    constexpr double ptsShift = 2048;
    const std::uint8_t* from = rows.columns[step.field].data();
    visitRows(field, [&](auto zero) {
        using From = decltype(zero);
        for (std::size_t i = 0; i < rows.count; ++i) {
            double value = asDouble(loadLe<From>(from + i * sizeof(From)));
            storeLe(to + i * sizeof(std::uint16_t), step.how == FieldStep::How::unit
                                                        ? toUnit(value)
                                                        : convertValue<std::uint16_t>(value + ptsShift));
        }
    });
}

// The bits of a packed colour: those of a float32 where the column is one.
std::uint32_t word(const TableField& field, const Rows& rows, std::size_t f, std::size_t i) {
    if (!field.isText)
        return loadLe<std::uint32_t>(rows.columns[f].data() + i * sizeof(std::uint32_t));
    Number number = rows.number(f, i);
    return *field.type == AttributeType::f32 ? bitCast<std::uint32_t>(toFloat(number))
                                             : static_cast<std::uint32_t>(toWhole(number).value);
}

void takeBytes(const TableField& field, const FieldStep& step, AttributeType type, const Rows& rows,
               std::uint8_t* to) {
    for (std::size_t i = 0; i < rows.count; ++i) {
        std::uint32_t byte = (word(field, rows, step.field, i) >> (8 * step.index)) & 0xFF;
        if (type == AttributeType::u8)
            to[i] = static_cast<std::uint8_t>(byte);
        else
            storeLe(to + i * sizeof(std::uint16_t), static_cast<std::uint16_t>(byte));
    }
}
} // namespace

TablePlan planTable(const Table& table, const std::vector<FieldRange>& ranges) {
    return Planner(table, ranges).plan();
}

void convertColumns(const Table& table, const TablePlan& plan, const Rows& rows, PointBatch& batch,
                    std::size_t at) {
    for (const FieldStep& step : plan.steps) {
        const TableField& field = table.fields[step.field];
        const Attribute& attribute = plan.schema.attributes[step.attribute];
        std::uint8_t* to = batch.columns[step.attribute].data() + at * attribute.size();
        const Bytes& column = rows.columns[step.field];
        switch (step.how) {
        case FieldStep::How::copy:
            std::copy_n(column.begin(), rows.count * attribute.size(), to);
            break;
        case FieldStep::How::value:
            visitType(attribute.type,
                      [&](auto zero) { convertValues<decltype(zero)>(field, step, rows, to); });
            break;
        case FieldStep::How::unit:
        case FieldStep::How::shifted:
            convertNumbers(field, step, rows, to);
            break;
        case FieldStep::How::byte:
            takeBytes(field, step, attribute.type, rows, to);
            break;
        }
    }
}

} // namespace stipple
