#include "shared/select/corridor_attributes.hpp"

#include "shared/base/text.hpp"

namespace stipple {

void addCorridorAttributes(CloudMetadata& metadata) {
    auto add = [&](const char* name, const char* description) {
        Attribute attribute;
        attribute.name = name;
        for (int i = 2; metadata.schema.find(attribute.name) >= 0; ++i)
            attribute.name = cat(name, " (", i, ")");
        attribute.type = AttributeType::f64;
        attribute.description = description;
        attribute.unit = metadata.crs.unit;
        metadata.schema.attributes.push_back(attribute);
    };
    add("Station", "along the profile's line");
    add("Offset", "left of the profile's line");
}

} // namespace stipple
