#include "shared/base/text.hpp"
#include "shared/format/block_frame.hpp"
#include "shared/format/file_parts.hpp"
#include "shared/format/picture_attributes.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

namespace stipple {

namespace {

using Json = nlohmann::json; // as the clients read all else, so that their programs hold one reader

// Reads fields of objects; the first one that is missing or of the wrong kind is what `error` names.
class Fields {
  public:
    Fields(const Json& object, std::string path, std::optional<Error>& error)
        : object_(object), path_(std::move(path)), error_(error) {
        if (!object.is_object())
            refuse(path_, say("an object"));
    }

    const Json* find(const char* name) const {
        if (!object_.is_object())
            return nullptr;
        auto found = object_.find(name);
        return found == object_.end() ? nullptr : &*found;
    }
    std::string pathOf(const char* name) const { return path_.empty() ? name : path_ + "." + name; }

    std::string text(const char* name) {
        return get<std::string>(name, "a text", [](const Json& j) { return j.is_string(); });
    }
    bool flag(const char* name) {
        return get<bool>(name, "true or false", [](const Json& j) { return j.is_boolean(); });
    }
    double number(const char* name) {
        const Json* json = find(name);
        return toNumber(json, pathOf(name));
    }
    std::uint64_t count(const char* name) { return toCount(find(name), pathOf(name)); }
    std::int64_t integer(const char* name, std::int64_t low, std::int64_t high) {
        std::int64_t value = toInteger(find(name), pathOf(name));
        if (value < low || value > high)
            refuse(pathOf(name), say("a number from ", low, " to ", high));
        return value;
    }
    // The index among `names`; 0 for something else.
    std::size_t choice(const char* name, std::span<const char* const> names) {
        std::string value = text(name), expected;
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (value == names[i])
                return i;
            expected += cat(i == 0 ? "" : i + 1 < names.size() ? ", " : " or ", names[i]);
        }
        refuse(pathOf(name), expected);
        return 0;
    }
    Vec3d numbers(const char* name) {
        Vec3d v;
        if (const Json* json = triple(name))
            for (int axis = 0; axis < 3; ++axis)
                v[axis] = toNumber(&(*json)[static_cast<std::size_t>(axis)], pathOf(name));
        return v;
    }
    Vec3i integers(const char* name) {
        Vec3i v;
        if (const Json* json = triple(name))
            for (int axis = 0; axis < 3; ++axis)
                v[axis] = toInteger(&(*json)[static_cast<std::size_t>(axis)], pathOf(name));
        return v;
    }
    // An array, or an empty one in place of something else.
    const Json& list(const char* name) {
        static const Json none = Json::array();
        const Json* json = find(name);
        if (json != nullptr && json->is_array())
            return *json;
        refuse(pathOf(name), say("a list"));
        return none;
    }

    double toNumber(const Json* json, const std::string& path) {
        if (json != nullptr && json->is_number())
            return json->get<double>();
        if (json != nullptr && json->is_string()) {
            const auto& text = json->get_ref<const std::string&>();
            constexpr double infinity = std::numeric_limits<double>::infinity();
            if (text == "NaN")
                return std::numeric_limits<double>::quiet_NaN();
            if (text == "Infinity" || text == "-Infinity")
                return text[0] == '-' ? -infinity : infinity;
        }
        refuse(path, say("a number"));
        return 0;
    }
    std::int64_t toInteger(const Json* json, const std::string& path) {
        bool fits = json != nullptr && json->is_number_integer() &&
                    (!json->is_number_unsigned() || json->get<std::uint64_t>() <= INT64_MAX);
        if (fits)
            return json->get<std::int64_t>();
        refuse(path, say("an integer"));
        return 0;
    }
    std::uint64_t toCount(const Json* json, const std::string& path) {
        if (json != nullptr && json->is_number_unsigned())
            return json->get<std::uint64_t>();
        refuse(path, say("a count"));
        return 0;
    }
    void refuse(const std::string& path, Phrase expected) {
        if (!error_)
            error_ = Error{ErrorCode::corrupt, say("\"", path, "\" is not ", expected), "metadata", {}};
    }

  private:
    template <class T, class Is>
    T get(const char* name, const char* expected, const Is& is) {
        const Json* json = find(name);
        if (json != nullptr && is(*json))
            return json->get<T>();
        refuse(pathOf(name), expected);
        return T{};
    }
    const Json* triple(const char* name) {
        const Json* json = find(name);
        if (json != nullptr && json->is_array() && json->size() == 3)
            return json;
        refuse(pathOf(name), say("a list of three numbers"));
        return nullptr;
    }

    const Json& object_;
    std::string path_;
    std::optional<Error>& error_;
};

const Json& part(Fields& fields, const char* name) {
    static const Json none;
    const Json* json = fields.find(name);
    return json != nullptr ? *json : none;
}

Crs readCrs(Fields crs, std::optional<Error>& error) {
    Crs read;
    read.name = crs.text("name");
    read.wkt = crs.text("wkt");
    if (crs.find("epsg") != nullptr)
        read.epsg = static_cast<int>(crs.integer("epsg", 0, INT32_MAX));
    read.proj = crs.text("proj");
    read.unit = crs.text("unit");
    read.unitMeters = crs.number("unitMeters");
    if (crs.find("vertical") != nullptr)
        read.vertical = crs.text("vertical");
    if (crs.find("axes") != nullptr)
        for (const Json& json : crs.list("axes")) {
            Fields axis(json, crs.pathOf("axes"), error);
            read.axes.push_back(
                {axis.text("name"), axis.text("direction"), axis.text("unit"), axis.number("unitMeters")});
        }
    return read;
}

Attribute readAttribute(Fields& fields) {
    Attribute attribute;
    attribute.name = fields.text("name");
    std::string type = fields.text("type");
    if (auto known = attributeTypeFromName(type))
        attribute.type = *known;
    else
        fields.refuse(fields.pathOf("type"), say("a known type"));
    attribute.components = static_cast<int>(fields.integer("components", 1, 255));
    attribute.description = fields.text("description");
    attribute.unit = fields.text("unit");
    attribute.scale = fields.number("scale");
    attribute.offset = fields.number("offset");
    if (fields.find("noData") != nullptr)
        attribute.noData = fields.number("noData");
    return attribute;
}

AttributeStatistics readStatistics(Fields& fields) {
    AttributeStatistics statistics;
    statistics.min = fields.number("min");
    statistics.max = fields.number("max");
    statistics.mean = fields.number("mean");
    statistics.deviation = fields.number("deviation");
    for (const Json& pair : fields.list("histogram")) {
        if (!pair.is_array() || pair.size() != 2) {
            fields.refuse(fields.pathOf("histogram"), say("a list of pairs"));
            break;
        }
        statistics.histogram.emplace_back(fields.toInteger(&pair[0], fields.pathOf("histogram")),
                                          fields.toCount(&pair[1], fields.pathOf("histogram")));
    }
    return statistics;
}

// What a reader relies on beyond each field's own kind.
void checkWhole(const CloudMetadata& metadata, Fields& fields) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!(metadata.grid.scale[axis] > 0) || !std::isfinite(metadata.grid.scale[axis]))
            fields.refuse("grid.scale", say("positive"));
        if (!std::isfinite(metadata.grid.offset[axis]))
            fields.refuse("grid.offset", say("finite"));
        constexpr std::int64_t farthest = std::int64_t{1} << 62;
        if (metadata.rootCube.min[axis] < -farthest || metadata.rootCube.min[axis] > farthest)
            fields.refuse("rootCube.min", say("within 2^62 steps of zero"));
    }
    for (std::size_t a = 0; a < metadata.schema.attributes.size(); ++a)
        if (metadata.schema.find(metadata.schema.attributes[a].name) != static_cast<int>(a))
            fields.refuse(cat("attributes[", a, "].name"), say("unique"));
    if (!checkPictureAttributes(metadata))
        fields.refuse("pictureColour", say("a colour that the attributes hold"));
    if (metadata.innerColour != InnerColour::exact && metadata.pictureColour == PictureColour::none)
        fields.refuse("innerColour", say("exact, although there is no colour"));
}

} // namespace

Result<CloudMetadata> parseMetadata(ByteSpan block) {
    STIPPLE_TRY(text, unframeBlock(block, "metadata", fileHeaderBytes));
    Json json = Json::parse(text.begin(), text.end(), nullptr, false);
    if (json.is_discarded())
        return Error{ErrorCode::corrupt, say("the text is no JSON"), "metadata", {}};
    std::optional<Error> error;
    Fields fields(json, "", error);
    CloudMetadata metadata;
    metadata.name = fields.text("name");
    metadata.pointCount = fields.count("pointCount");
    metadata.crs = readCrs(Fields(part(fields, "crs"), "crs", error), error);
    Fields grid(part(fields, "grid"), "grid", error);
    metadata.grid = {grid.numbers("scale"), grid.numbers("offset")};
    Fields cube(part(fields, "rootCube"), "rootCube", error);
    metadata.rootCube = {cube.integers("min"), static_cast<int>(cube.integer("bits", 0, maxRootBits))};
    metadata.spacing = fields.number("spacing");
    if (fields.find("sampling") != nullptr)
        metadata.sampling = static_cast<Sampling>(fields.choice("sampling", samplingNames));
    if (fields.find("bounds") != nullptr) {
        Fields bounds(part(fields, "bounds"), "bounds", error);
        metadata.bounds.min = bounds.integers("min");
        metadata.bounds.max = bounds.integers("max");
    }
    metadata.pictureColour = static_cast<PictureColour>(fields.choice("pictureColour", pictureColourNames));
    if (fields.find("innerColour") != nullptr)
        metadata.innerColour = static_cast<InnerColour>(fields.choice("innerColour", innerColourNames));
    metadata.colourIs8Bit = fields.flag("colourIs8Bit");
    const Json& attributes = fields.list("attributes");
    if (attributes.size() > maxAttributes)
        fields.refuse("attributes", say("a list of at most ", maxAttributes));
    for (std::size_t a = 0; a < attributes.size() && !error; ++a) {
        Fields attribute(attributes[a], cat("attributes[", a, "]"), error);
        metadata.schema.attributes.push_back(readAttribute(attribute));
        metadata.statistics.push_back(readStatistics(attribute));
    }
    metadata.pointHash = fields.text("pointHash");
    const Json& sources = fields.list("sources");
    for (std::size_t s = 0; s < sources.size() && !error; ++s) {
        Fields source(sources[s], cat("sources[", s, "]"), error);
        metadata.sources.push_back({source.text("name"), source.text("format"), source.count("pointCount"),
                                    source.count("sizeBytes"),
                                    source.find("pointHash") ? source.text("pointHash") : std::string()});
    }
    metadata.tool = fields.text("tool");
    metadata.options = fields.text("options");
    if (!error)
        checkWhole(metadata, fields);
    if (error)
        return *error;
    return metadata;
}

} // namespace stipple
