#include "converter/crs/geotiff_keys.hpp"

#include "shared/base/text.hpp"

#include <algorithm>

namespace stipple {

namespace {

const las::Vlr* findRecord(const las::Header& header, std::uint16_t id) {
    for (const las::Vlr& vlr : header.vlrs)
        if (vlr.is(las::records::projection, id) && !vlr.omitted)
            return &vlr;
    return nullptr;
}

// Does the key's value lie where it says?
bool isSound(const GeoKey& key, const GeoKeys& arrays) {
    std::size_t end = std::size_t{key.value} + key.count;
    switch (key.tag) {
    case 0:
        return key.count == 1;
    case las::records::geoDoubleParams:
        return key.count > 0 && end <= arrays.doubles.size();
    case las::records::geoAsciiParams:
        return key.count > 0 && end <= arrays.characters.size();
    default:
        return false;
    }
}

} // namespace

int GeoKeys::number(std::uint16_t id) const {
    for (const GeoKey& key : keys)
        if (key.id == id && key.tag == 0)
            return key.value;
    return -1;
}

std::vector<std::uint16_t> GeoKeys::directory() const {
    std::vector<std::uint16_t> numbers{1, 1, 0, static_cast<std::uint16_t>(keys.size())};
    for (const GeoKey& key : keys)
        numbers.insert(numbers.end(), {key.id, key.tag, key.count, key.value});
    return numbers;
}

GeoKeys geoKeysOf(const las::Header& header, std::vector<std::string>& warnings) {
    GeoKeys found;
    const las::Vlr* directory = findRecord(header, las::records::geoKeyDirectory);
    if (!directory)
        return found;
    if (const las::Vlr* doubles = findRecord(header, las::records::geoDoubleParams))
        for (std::size_t at = 0; at + 8 <= doubles->data.size(); at += 8)
            found.doubles.push_back(loadLe<double>(doubles->data.data() + at));
    if (const las::Vlr* text = findRecord(header, las::records::geoAsciiParams))
        found.characters.assign(text->data.begin(), text->data.end());

    ByteReader reader(directory->data);
    std::uint16_t version = reader.read<std::uint16_t>();
    reader.skip(4); // revision
    std::size_t claimed = reader.read<std::uint16_t>();
    if (!reader.ok() || version != 1) {
        warnings.push_back(cat("the GeoTIFF key directory (", directory->data.size(),
                               " bytes) does not begin with version 1; it is ignored"));
        return found;
    }
    std::size_t held = std::min(claimed, reader.remaining() / 8);
    if (held < claimed)
        warnings.push_back(cat("the GeoTIFF key directory counts ", claimed, " keys, but holds ", held));
    for (std::size_t i = 0; i < held; ++i) {
        GeoKey key;
        key.id = reader.read<std::uint16_t>();
        key.tag = reader.read<std::uint16_t>();
        key.count = reader.read<std::uint16_t>();
        key.value = reader.read<std::uint16_t>();
        if (key.id == 0)
            warnings.push_back(cat("GeoTIFF key ", i + 1, " of ", claimed, " is empty; it is ignored"));
        else if (!isSound(key, found))
            warnings.push_back(cat("GeoTIFF key ", key.id, " refers to ", key.count, " values from ",
                                   key.value, " of tag ", key.tag, ", which are not there; it is ignored"));
        else
            found.keys.push_back(key);
    }
    auto byId = [](const GeoKey& a, const GeoKey& b) { return a.id < b.id; };
    std::stable_sort(found.keys.begin(), found.keys.end(), byId);
    auto sameId = [](const GeoKey& a, const GeoKey& b) { return a.id == b.id; };
    auto doubled = std::unique(found.keys.begin(), found.keys.end(), sameId);
    if (doubled != found.keys.end())
        warnings.push_back("GeoTIFF keys are there more than once; the first of each holds");
    found.keys.erase(doubled, found.keys.end());
    return found;
}

} // namespace stipple
