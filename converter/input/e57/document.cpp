#include "converter/input/e57/document.hpp"

#include "converter/input/e57/paged_file.hpp"
#include "converter/input/e57/xml_values.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stipple::e57 {

namespace {
constexpr int maxPrototypeDepth = 8;
constexpr double unitTolerance = 1e-6; // of a quaternion's length

int bitsOf(std::int64_t minimum, std::int64_t maximum) {
    return static_cast<int>(
        std::bit_width(static_cast<std::uint64_t>(maximum) - static_cast<std::uint64_t>(minimum)));
}

// A leaf of a prototype.
Result<Field> parseField(const XmlElement& element, std::string name) {
    Field field;
    field.name = std::move(name);
    std::string_view type = element.type();
    if (type == "Float") {
        std::string_view precision = element.attribute("precision");
        if (!precision.empty() && precision != "single" && precision != "double")
            return element.error(ErrorCode::corrupt, cat("\"", precision, "\" is no precision"));
        field.kind = precision == "single" ? FieldKind::float32 : FieldKind::float64;
        field.bits = precision == "single" ? 32 : 64;
    } else if (type == "Integer" || type == "ScaledInteger") {
        field.kind = type == "Integer" ? FieldKind::integer : FieldKind::scaledInteger;
        STIPPLE_TRY(minimum, element.integerAttribute("minimum", std::numeric_limits<std::int64_t>::min()));
        STIPPLE_TRY(maximum, element.integerAttribute("maximum", std::numeric_limits<std::int64_t>::max()));
        if (maximum < minimum)
            return element.error(ErrorCode::corrupt, "its maximum is less than its minimum");
        field.minimum = minimum;
        field.maximum = maximum;
        field.bits = bitsOf(minimum, maximum);
        if (field.kind == FieldKind::scaledInteger) {
            STIPPLE_TRY(scale, element.numberAttribute("scale", 1));
            STIPPLE_TRY(offset, element.numberAttribute("offset", 0));
            field.scale = scale;
            field.offset = offset;
        }
    } else if (type == "String") {
        field.kind = FieldKind::text;
        field.bits = 0;
    } else {
        return element.error(ErrorCode::unsupported,
                             cat("a record can't hold a value of type \"", type, "\""));
    }
    return field;
}

// The leaves below `parent`, in document order: that of the byte streams (§9.3).
Status parseFields(const XmlElement& parent, const std::string& prefix, int depth,
                   std::vector<Field>& fields) {
    if (depth > maxPrototypeDepth)
        return parent.error(ErrorCode::limitExceeded, "the prototype is nested too deeply");
    for (XmlElement child : parent.children()) {
        std::string name = prefix + std::string(child.name());
        if (child.type() == "Structure" || child.type() == "Vector") {
            STIPPLE_CHECK(parseFields(child, name + "/", depth + 1, fields));
            continue;
        }
        if (fields.size() == maxFields)
            return child.error(ErrorCode::limitExceeded,
                               cat("a record has more than ", maxFields, " fields"));
        STIPPLE_TRY(field, parseField(child, name));
        auto isTaken = [&](const std::string& wanted) {
            return std::any_of(fields.begin(), fields.end(),
                               [&](const Field& f) { return f.name == wanted; });
        };
        if (isTaken(name) && prefix.empty())
            return child.error(ErrorCode::corrupt, "the prototype has two fields of this name");
        for (int copy = 2; isTaken(field.name); ++copy) // the children of a vector share their name
            field.name = cat(name, "#", copy);
        fields.push_back(std::move(field));
    }
    return {};
}

Status checkCodecs(const XmlElement& points) {
    for (XmlElement codec : points.child("codecs").children())
        for (XmlElement part : codec.children())
            if (part.name() != "inputs" && part.name() != "bitPackCodec")
                return part.error(ErrorCode::unsupported,
                                  cat("records are packed by the codec \"", part.name(),
                                      "\"; only the standard's bitPackCodec is read"));
    return {};
}

Status parsePoints(const XmlElement& points, ScanEntry& scan) {
    if (points.type() != "CompressedVector")
        return points.error(ErrorCode::corrupt,
                            cat("the points are of type \"", points.type(), "\", not a CompressedVector"));
    STIPPLE_TRY(fileOffset, points.unsignedAttribute("fileOffset"));
    STIPPLE_TRY(recordCount, points.unsignedAttribute("recordCount"));
    XmlElement prototype = points.child("prototype");
    if (!prototype)
        return points.error(ErrorCode::corrupt,
                            "the points have no prototype, which says what a record holds");
    STIPPLE_CHECK(checkCodecs(points));
    STIPPLE_CHECK(parseFields(prototype, "", 0, scan.fields));
    scan.hasPoints = true;
    scan.fileOffset = fileOffset;
    scan.recordCount = recordCount;
    return {};
}

// Limits that are no range of numbers are none.
Result<std::optional<Range>> parseRange(const XmlElement& limits, const char* low, const char* high) {
    std::optional<Range> range;
    STIPPLE_TRY(min, limits.childNumber(low));
    STIPPLE_TRY(max, limits.childNumber(high));
    if (min && max && *min < *max)
        range = {*min, *max};
    return range;
}

Status parseLimits(const XmlElement& element, ScanEntry& scan) {
    STIPPLE_TRY(intensity,
                parseRange(element.child("intensityLimits"), "intensityMinimum", "intensityMaximum"));
    scan.intensityLimits = intensity;
    XmlElement colours = element.child("colorLimits");
    STIPPLE_TRY(red, parseRange(colours, "colorRedMinimum", "colorRedMaximum"));
    STIPPLE_TRY(green, parseRange(colours, "colorGreenMinimum", "colorGreenMaximum"));
    STIPPLE_TRY(blue, parseRange(colours, "colorBlueMinimum", "colorBlueMaximum"));
    scan.colourLimits = {red, green, blue};
    XmlElement bounds = element.child("cartesianBounds");
    constexpr const char* names[6] = {"xMinimum", "yMinimum", "zMinimum", "xMaximum", "yMaximum", "zMaximum"};
    BoxD box;
    for (int i = 0; i < 6; ++i) {
        STIPPLE_TRY(value, bounds.childNumber(names[i]));
        if (!value)
            return {};
        (i < 3 ? box.min : box.max)[i % 3] = *value;
    }
    scan.cartesianBounds = box;
    return {};
}

// Row-major, from a quaternion of any length but 0 (§8.4.13 asks for 1).
std::array<double, 9> rotationMatrix(double w, double x, double y, double z) {
    double s = 2 / (w * w + x * x + y * y + z * z);
    return {1 - s * (y * y + z * z), s * (x * y - w * z),     s * (x * z + w * y),
            s * (x * y + w * z),     1 - s * (x * x + z * z), s * (y * z - w * x),
            s * (x * z - w * y),     s * (y * z + w * x),     1 - s * (x * x + y * y)};
}

Status parsePose(const XmlElement& element, ScanEntry& scan, std::vector<std::string>& warnings) {
    XmlElement pose = element.child("pose");
    auto numbers = [](const XmlElement& parent, std::initializer_list<const char*> names,
                      double* out) -> Status {
        for (const char* name : names) {
            STIPPLE_TRY(value, parent.childNumber(name));
            if (value && !std::isfinite(*value))
                return parent.error(ErrorCode::corrupt, "the pose has a number that is not finite");
            *out++ = value.value_or(0);
        }
        return {};
    };
    double t[3];
    STIPPLE_CHECK(numbers(pose.child("translation"), {"x", "y", "z"}, t));
    scan.pose.translation = {t[0], t[1], t[2]};
    XmlElement rotation = pose.child("rotation");
    if (!rotation)
        return {};
    double q[4];
    STIPPLE_CHECK(numbers(rotation, {"w", "x", "y", "z"}, q));
    double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 0) || !std::isfinite(length)) {
        warnings.push_back(cat("the rotation of scan ", scan.number, " has length ", length,
                               ", so it is none; the scan is taken as not rotated"));
        return {};
    }
    if (std::abs(length - 1) > unitTolerance)
        warnings.push_back(cat("the rotation of scan ", scan.number, " is a quaternion of length ", length,
                               ", not 1; it is scaled to 1"));
    scan.pose.rotates = q[1] != 0 || q[2] != 0 || q[3] != 0;
    if (scan.pose.rotates)
        scan.pose.rotation = rotationMatrix(q[0] / length, q[1] / length, q[2] / length, q[3] / length);
    return {};
}

Result<ScanEntry> parseScan(const XmlElement& element, int number, std::vector<std::string>& warnings) {
    ScanEntry scan;
    scan.number = number;
    scan.name = element.child("name").text();
    XmlElement points = element.child("points");
    if (!points)
        return scan;
    STIPPLE_CHECK(parsePoints(points, scan));
    STIPPLE_CHECK(parseLimits(element, scan));
    STIPPLE_CHECK(parsePose(element, scan, warnings));
    STIPPLE_TRY(start, element.child("acquisitionStart").childNumber("dateTimeValue"));
    scan.acquisitionStart = start;
    return scan;
}
} // namespace

Result<Document> parseDocument(ByteSpan xml, std::uint64_t xmlOffset) {
    XmlText text;
    STIPPLE_CHECK(text.parse(xml, xmlOffset));
    XmlElement root = text.root();
    if (root.name() != "e57Root")
        return root.error(ErrorCode::corrupt, "the XML section does not hold an e57Root");
    Document document;
    document.coordinateMetadata = root.child("coordinateMetadata").text();
    for ([[maybe_unused]] XmlElement picture : root.child("images2D").children())
        ++document.pictures;
    int number = 0;
    for (XmlElement child : root.child("data3D").children()) {
        auto scan = parseScan(child, ++number, document.warnings);
        if (!scan)
            return scan.error().at(cat("scan ", number));
        document.scans.push_back(std::move(scan).value());
    }
    return document;
}

} // namespace stipple::e57
