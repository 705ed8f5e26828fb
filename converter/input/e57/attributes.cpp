#include "converter/input/e57/attributes.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace stipple::e57 {

namespace {
using How = AttributeSource::How;
using Int128 = __int128;
using Scans = std::vector<const ScanEntry*>;

constexpr double gpsAdjustment = 1e9; // LAS 1.4 table 9: adjusted standard GPS time is GPS time less 10^9 s
constexpr std::int64_t largestU8 = 255, largestU16 = 65535;
constexpr std::int64_t from8To16 = 257; // 255 × 257 = 65535
constexpr std::array<std::string_view, 3> colourFields{"colorRed", "colorGreen", "colorBlue"};
constexpr std::array colourNames{attribute_names::red, attribute_names::green, attribute_names::blue};
// Those that have a LAS name come first, in the order of LAS.
constexpr std::array lasOrder{attribute_names::intensity,
                              attribute_names::returnNumber,
                              attribute_names::numberOfReturns,
                              attribute_names::classification,
                              attribute_names::pointSourceId,
                              attribute_names::gpsTime,
                              attribute_names::red,
                              attribute_names::green,
                              attribute_names::blue};

// What one scan has of an attribute.
struct Wish {
    AttributeSource source;
    Int128 low = 0, high = 0; // of stored integers
    bool isInteger = true, isSingle = false;
    double scale = 1, offset = 0;
    std::optional<AttributeType> type; // where the name asks for it
    std::string description;
};
using Wishes = std::map<std::string, std::vector<std::optional<Wish>>>; // name → of each scan

const Field* fieldOf(const ScanEntry& scan, std::string_view name) {
    int index = scan.find(name);
    const Field* field = index < 0 ? nullptr : &scan.fields[static_cast<std::size_t>(index)];
    return field && field->kind != FieldKind::text ? field : nullptr;
}
std::size_t indexOf(const ScanEntry& scan, const Field& field) {
    return static_cast<std::size_t>(&field - scan.fields.data());
}
int flagOf(const ScanEntry& scan, std::string_view name) {
    const Field* field = fieldOf(scan, name);
    return field && field->isInteger() ? static_cast<int>(indexOf(scan, *field)) : -1;
}

// The largest integer that a stream can hold of the field, whatever its maximum says.
Int128 highest(const Field& field) {
    Int128 high = Int128{field.minimum} + ((Int128{1} << field.bits) - 1);
    return std::min(high, Int128{std::numeric_limits<std::int64_t>::max()});
}
bool isPlainWithin(const Field& field, std::int64_t max) {
    return field.kind == FieldKind::integer && field.minimum >= 0 && highest(field) <= max;
}

Wish asStated(const ScanEntry& scan, const Field& field) {
    Wish wish;
    wish.source.field = indexOf(scan, field);
    wish.source.how = field.isInteger() ? How::integer : How::number;
    wish.isInteger = field.isInteger();
    wish.isSingle = field.kind == FieldKind::float32;
    if (field.isInteger()) {
        wish.low = field.minimum;
        wish.high = highest(field);
        wish.scale = field.scale;
        wish.offset = field.offset;
    }
    return wish;
}
Wish withType(Wish wish, AttributeType type, int invalid) {
    wish.type = type;
    wish.source.invalid = invalid;
    return wish;
}
Wish stretched(const ScanEntry& scan, const Field& field, Range range, double full, int invalid) {
    Wish wish = withType(asStated(scan, field), AttributeType::u16, invalid);
    wish.source.how = How::stretched;
    wish.source.range = range;
    wish.source.full = full;
    wish.scale = 1;
    wish.offset = 0;
    wish.description = cat(field.name, " from ", range.min, " to ", range.max, " as 0 to ", full);
    return wish;
}

void extend(std::optional<Range>& range, const std::optional<Range>& other) {
    if (other)
        range = range ? Range{std::min(range->min, other->min), std::max(range->max, other->max)} : *other;
}

// --- intensity ---

bool intensityIsPlain(const Scans& scans) {
    return std::all_of(scans.begin(), scans.end(), [](const ScanEntry* scan) {
        const Field* field = fieldOf(*scan, "intensity");
        return !field || isPlainWithin(*field, largestU16);
    });
}

// --- colours ---

// 255 or 65535 where the scan's colours are integers up to that, to be taken as they are; else 0.
std::int64_t statedFull(const ScanEntry& scan) {
    double largest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const Field* field = fieldOf(scan, colourFields[c]);
        if (!field)
            continue;
        if (!isPlainWithin(*field, largestU16))
            return 0;
        largest = std::max(largest, scan.colourLimits[c] ? scan.colourLimits[c]->max
                                                         : static_cast<double>(field->maximum));
    }
    if (largest <= largestU8)
        return largestU8;
    for (int bits = 9; bits < 16; ++bits) // a camera's 10 or 12 bits: too dark as 16
        if (largest == static_cast<double>((1 << bits) - 1))
            return 0;
    return largestU16;
}

bool hasColour(const ScanEntry& scan) {
    return std::any_of(colourFields.begin(), colourFields.end(),
                       [&](std::string_view name) { return fieldOf(scan, name) != nullptr; });
}

// What a field is stretched from: its limits, or what was measured of it.
std::optional<Range> rangeOf(std::size_t scan, const ScanEntry& entry, const Field& field,
                             const std::optional<Range>& limits, const MeasuredRanges& measured) {
    return limits ? limits : measured[scan][indexOf(entry, field)];
}

class Planner {
  public:
    Planner(const Scans& scans, const std::vector<CoordinateFields>& coordinates,
            const MeasuredRanges& measured)
        : scans_(scans), coordinates_(coordinates), measured_(measured) {}

    AttributePlan plan() {
        planIntensity();
        planColours();
        planTime();
        for (std::size_t s = 0; s < scans_.size(); ++s) {
            planReturns(s);
            planOwnNames(s);
            Wish number =
                withType({}, scans_.size() > largestU16 ? AttributeType::u32 : AttributeType::u16, -1);
            number.source.add = scans_[s]->number;
            number.description = scanNames();
            wish(attribute_names::pointSourceId, s, number);
        }
        for (std::string_view name : lasOrder)
            if (wishes_.count(std::string(name)) > 0)
                take(std::string(name));
        for (const std::string& name : order_)
            take(name);
        return finish();
    }

  private:
    void wish(std::string_view name, std::size_t scan, Wish wish) {
        auto [entry, isNew] = wishes_.try_emplace(std::string(name));
        if (isNew) {
            entry->second.resize(scans_.size());
            order_.push_back(entry->first);
        }
        entry->second[scan] = std::move(wish);
    }

    void planIntensity() {
        bool plain = intensityIsPlain(scans_);
        std::optional<Range> range;
        for (std::size_t s = 0; s < scans_.size() && !plain; ++s)
            if (const Field* field = fieldOf(*scans_[s], "intensity"))
                extend(range, rangeOf(s, *scans_[s], *field, scans_[s]->intensityLimits, measured_));
        for (std::size_t s = 0; s < scans_.size(); ++s) {
            const ScanEntry& scan = *scans_[s];
            const Field* field = fieldOf(scan, "intensity");
            if (!field)
                continue;
            int invalid = flagOf(scan, "isIntensityInvalid");
            if (plain) {
                wish(attribute_names::intensity, s,
                     withType(asStated(scan, *field), AttributeType::u16, invalid));
                done_.insert({s, indexOf(scan, *field)});
            } else {
                wish(attribute_names::intensity, s,
                     stretched(scan, *field, range.value_or(Range{}), largestU16, invalid));
            }
        }
    }

    void planColours() {
        std::optional<Range> range; // of all that are stretched, so that grey stays grey
        bool all8 = true;
        for (std::size_t s = 0; s < scans_.size(); ++s) {
            if (!hasColour(*scans_[s]))
                continue;
            std::int64_t full = statedFull(*scans_[s]);
            std::optional<Range> own = full == 0 ? colourRange(s) : std::nullopt;
            extend(range, own);
            all8 = all8 && (full == largestU8 ||
                            (own && own->min == 0 && own->max == static_cast<double>(largestU8)));
        }
        std::int64_t fileFull = all8 ? largestU8 : largestU16;
        for (std::size_t s = 0; s < scans_.size(); ++s)
            for (std::size_t c = 0; c < 3; ++c)
                if (const Field* field = fieldOf(*scans_[s], colourFields[c]))
                    planColour(s, c, *field, range.value_or(Range{}), fileFull);
    }

    std::optional<Range> colourRange(std::size_t s) const {
        std::optional<Range> range;
        for (std::size_t c = 0; c < 3; ++c)
            if (const Field* field = fieldOf(*scans_[s], colourFields[c]))
                extend(range, rangeOf(s, *scans_[s], *field, scans_[s]->colourLimits[c], measured_));
        return range;
    }

    void planColour(std::size_t s, std::size_t c, const Field& field, Range range, std::int64_t fileFull) {
        const ScanEntry& scan = *scans_[s];
        int invalid = flagOf(scan, "isColorInvalid");
        std::int64_t full = statedFull(scan);
        if (full == 0)
            return wish(colourNames[c], s,
                        stretched(scan, field, range, static_cast<double>(fileFull), invalid));
        Wish stated = withType(asStated(scan, field), AttributeType::u16, invalid);
        stated.source.multiply = full < fileFull ? from8To16 : 1;
        wish(colourNames[c], s, stated);
        if (stated.source.multiply == 1 || highest(field) <= largestU8)
            done_.insert({s, indexOf(scan, field)});
    }

    // As adjusted standard time if each scan says when it began; else as the seconds that the scans count.
    void planTime() {
        bool allStart = true, any = false;
        for (const ScanEntry* scan : scans_)
            if (fieldOf(*scan, "timeStamp")) {
                any = true;
                allStart = allStart && scan->acquisitionStart.has_value();
            }
        for (std::size_t s = 0; s < scans_.size(); ++s) {
            const Field* field = fieldOf(*scans_[s], "timeStamp");
            if (!field)
                continue;
            Wish time = withType(asStated(*scans_[s], *field), AttributeType::f64,
                                 flagOf(*scans_[s], "isTimeStampInvalid"));
            time.source.how = How::number;
            time.source.shift = allStart ? *scans_[s]->acquisitionStart - gpsAdjustment : 0;
            time.scale = 1;
            time.offset = 0;
            wish(attribute_names::gpsTime, s, time);
            done_.insert({s, indexOf(*scans_[s], *field)});
        }
        if (any && allStart)
            plan_.gpsTime = GpsTimeKind::adjustedStandard;
        else if (any)
            plan_.warnings.push_back("its times count from the start of each scan, and not every scan says "
                                     "when that was");
    }

    void planReturns(std::size_t s) {
        const ScanEntry& scan = *scans_[s];
        planByte(s, fieldOf(scan, "returnIndex"), attribute_names::returnNumber, 1);
        planByte(s, fieldOf(scan, "returnCount"), attribute_names::numberOfReturns, 0);
        const Field* classes = fieldOf(scan, "classification");
        if (classes && isPlainWithin(*classes, largestU8))
            planByte(s, classes, attribute_names::classification, 0);
    }
    // As a byte; and as stated, too, where its values may exceed one.
    void planByte(std::size_t s, const Field* field, std::string_view name, std::int64_t add) {
        if (!field || field->kind != FieldKind::integer)
            return;
        Wish byte = withType(asStated(*scans_[s], *field), AttributeType::u8, -1);
        byte.source.add = add;
        wish(name, s, byte);
        if (isPlainWithin(*field, largestU8 - add))
            done_.insert({s, indexOf(*scans_[s], *field)});
    }

    void planOwnNames(std::size_t s) {
        const ScanEntry& scan = *scans_[s];
        const CoordinateFields& used = coordinates_[s];
        std::string skipped;
        for (std::size_t f = 0; f < scan.fields.size(); ++f) {
            const Field& field = scan.fields[f];
            if (field.kind == FieldKind::text)
                skipped += cat(skipped.empty() ? "" : ", ", field.name);
            bool isCoordinate = std::find(used.axes.begin(), used.axes.end(), f) != used.axes.end() ||
                                static_cast<int>(f) == used.invalidState;
            if (field.kind == FieldKind::text || isCoordinate || done_.count({s, f}) > 0)
                continue;
            bool reserved = std::find(lasOrder.begin(), lasOrder.end(), field.name) != lasOrder.end();
            wish(reserved ? cat(field.name, " (E57)") : field.name, s, asStated(scan, field));
        }
        if (!skipped.empty())
            plan_.warnings.push_back(cat("scan ", scan.number, ": text is not read: ", skipped));
    }

    // "number of the scan: 1 hall, 2 yard"
    std::string scanNames() const {
        constexpr std::size_t enough = 300;
        std::string text;
        for (const ScanEntry* scan : scans_)
            if (!scan->name.empty() && text.size() + scan->name.size() < enough)
                text += cat(text.empty() ? ": " : ", ", scan->number, " ", scan->name);
        return "number of the scan" + text;
    }

    // The attribute `name` out of what the scans have of it.
    void take(const std::string& name) {
        auto found = wishes_.find(name);
        if (found == wishes_.end())
            return; // taken already
        std::vector<std::optional<Wish>> wishes = std::move(found->second);
        wishes_.erase(found);
        Attribute attribute;
        attribute.name = name;
        combine(wishes, attribute);
        plan_.schema.attributes.push_back(attribute);
        bool missing = false;
        plan_.sources.resize(scans_.size());
        for (std::size_t s = 0; s < wishes.size(); ++s) {
            missing = missing || !wishes[s];
            plan_.sources[s].push_back(wishes[s] ? wishes[s]->source : AttributeSource{});
        }
        if (missing)
            incomplete_ += cat(incomplete_.empty() ? "" : ", ", name);
    }

    static void combine(std::vector<std::optional<Wish>>& wishes, Attribute& attribute) {
        const Wish* first = nullptr;
        bool sameIntegers = true, allSingle = true;
        Int128 low = 0, high = 0; // 0 stands where a scan lacks the attribute
        for (const auto& wish : wishes) {
            if (!wish)
                continue;
            first = first ? first : &*wish;
            sameIntegers = sameIntegers && wish->isInteger && wish->scale == first->scale &&
                           wish->offset == first->offset;
            allSingle = allSingle && wish->isSingle;
            low = std::min(low, wish->low);
            high = std::max(high, wish->high);
        }
        attribute.description = first->description;
        if (first->type) {
            attribute.type = *first->type;
        } else if (sameIntegers) {
            attribute.type = integerType(low, high);
            attribute.scale = first->scale;
            attribute.offset = first->offset;
        } else {
            attribute.type = allSingle ? AttributeType::f32 : AttributeType::f64;
            for (auto& wish : wishes)
                if (wish)
                    wish->source.how = How::number;
        }
    }

    static AttributeType integerType(Int128 low, Int128 high) {
        if (low >= 0)
            return high <= largestU8                                   ? AttributeType::u8
                   : high <= largestU16                                ? AttributeType::u16
                   : high <= std::numeric_limits<std::uint32_t>::max() ? AttributeType::u32
                                                                       : AttributeType::i64;
        auto fits = [&](auto limits) { return low >= limits.lowest() && high <= limits.max(); };
        return fits(std::numeric_limits<std::int8_t>{})    ? AttributeType::i8
               : fits(std::numeric_limits<std::int16_t>{}) ? AttributeType::i16
               : fits(std::numeric_limits<std::int32_t>{}) ? AttributeType::i32
                                                           : AttributeType::i64;
    }

    AttributePlan finish() {
        if (!incomplete_.empty())
            plan_.warnings.push_back(cat("filled with 0 for scans that do not have it: ", incomplete_));
        return std::move(plan_);
    }

    const Scans& scans_;
    const std::vector<CoordinateFields>& coordinates_;
    const MeasuredRanges& measured_;
    Wishes wishes_;
    std::vector<std::string> order_;                     // names, as they came
    std::set<std::pair<std::size_t, std::size_t>> done_; // (scan, field): wholly in a LAS attribute
    AttributePlan plan_;
    std::string incomplete_;
};
} // namespace

std::vector<std::size_t> AttributePlan::fieldsOf(std::size_t scan) const {
    std::set<std::size_t> fields;
    for (const AttributeSource& source : sources[scan]) {
        if (source.how != How::constant)
            fields.insert(source.field);
        if (source.invalid >= 0)
            fields.insert(static_cast<std::size_t>(source.invalid));
    }
    return {fields.begin(), fields.end()};
}

std::vector<std::vector<std::size_t>> fieldsToMeasure(const std::vector<const ScanEntry*>& scans) {
    std::vector<std::vector<std::size_t>> result(scans.size());
    bool plainIntensity = intensityIsPlain(scans);
    for (std::size_t s = 0; s < scans.size(); ++s) {
        const ScanEntry& scan = *scans[s];
        const Field* intensity = fieldOf(scan, "intensity");
        if (intensity && !plainIntensity && !scan.intensityLimits)
            result[s].push_back(indexOf(scan, *intensity));
        for (std::size_t c = 0; c < 3; ++c)
            if (const Field* field = fieldOf(scan, colourFields[c]))
                if (statedFull(scan) == 0 && !scan.colourLimits[c])
                    result[s].push_back(indexOf(scan, *field));
    }
    return result;
}

AttributePlan planAttributes(const std::vector<const ScanEntry*>& scans,
                             const std::vector<CoordinateFields>& coordinates,
                             const MeasuredRanges& measured) {
    return Planner(scans, coordinates, measured).plan();
}

} // namespace stipple::e57
