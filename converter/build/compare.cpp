#include "converter/build/compare.hpp"

#include "converter/build/morton.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace stipple {

namespace {
std::string hexBytes(const std::uint8_t* bytes, std::size_t size) {
    std::string text;
    for (std::size_t i = 0; i < size; ++i) {
        text += "0123456789abcdef"[bytes[i] >> 4];
        text += "0123456789abcdef"[bytes[i] & 15];
    }
    return text;
}

template <class T>
std::string number(const std::uint8_t* bytes) {
    return cat(loadLe<T>(bytes));
}
std::string valueText(const Attribute& attribute, const std::uint8_t* bytes) {
    if (attribute.components > 1)
        return hexBytes(bytes, attribute.size());
    switch (attribute.type) {
    case AttributeType::u8:
        return cat(static_cast<int>(*bytes));
    case AttributeType::i8:
        return cat(static_cast<int>(static_cast<std::int8_t>(*bytes)));
    case AttributeType::u16:
        return number<std::uint16_t>(bytes);
    case AttributeType::i16:
        return number<std::int16_t>(bytes);
    case AttributeType::u32:
        return number<std::uint32_t>(bytes);
    case AttributeType::i32:
        return number<std::int32_t>(bytes);
    case AttributeType::u64:
        return number<std::uint64_t>(bytes);
    case AttributeType::i64:
        return number<std::int64_t>(bytes);
    case AttributeType::f32:
        return number<float>(bytes);
    case AttributeType::f64:
        return number<double>(bytes);
    }
    return {};
}

constexpr const char* missingText = "a point of the inputs is not in the file";

Comparison::Difference difference(const Grid& grid, Vec3i position, const std::string& what,
                                  std::uint64_t count) {
    Vec3d world = grid.toWorld(position);
    char place[120];
    std::snprintf(place, sizeof place, "at (%.10g, %.10g, %.10g): ", world.x, world.y, world.z);
    return {position, cat(place, what, count > 1 ? cat(" (", count, " times)") : "")};
}

void keepFirst(std::vector<Comparison::Difference>& differences) {
    std::sort(differences.begin(), differences.end());
    if (differences.size() > Comparison::mostDifferences)
        differences.resize(Comparison::mostDifferences);
}
} // namespace

bool operator<(const Comparison::Difference& a, const Comparison::Difference& b) {
    int order = compareMorton(a.position, b.position);
    return order != 0 ? order < 0 : a.text < b.text;
}

void Comparison::add(const Comparison& other) {
    filePoints += other.filePoints;
    inputPoints += other.inputPoints;
    equalPoints += other.equalPoints;
    changed += other.changed;
    changedPerAttribute.resize(std::max(changedPerAttribute.size(), other.changedPerAttribute.size()));
    for (std::size_t a = 0; a < other.changedPerAttribute.size(); ++a)
        changedPerAttribute[a] += other.changedPerAttribute[a];
    missing += other.missing;
    surplus += other.surplus;
    first.insert(first.end(), other.first.begin(), other.first.end());
    keepFirst(first);
}

void Comparison::addMissing(const Grid& grid, Vec3i position) {
    constexpr std::size_t untilSorted = 16 * mostDifferences;
    ++inputPoints;
    ++missing;
    first.push_back(difference(grid, position, missingText, 1));
    if (first.size() >= untilSorted)
        keepFirst(first);
}

PointComparer::PointComparer(const RowLayout& layout, const Grid& grid)
    : layout_(layout), grid_(grid), file_(layout.rowBytes()), missing_(layout.rowBytes()) {
    begin(0);
}

void PointComparer::begin(std::size_t filePoints) {
    file_.clear(filePoints);
    missing_.clear(0);
    result_ = {};
    result_.changedPerAttribute.assign(layout_.schema().attributes.size(), 0);
}

// A few rows at a time, so that the memory for one is fetched while others are looked up.
template <class Take>
void PointComparer::forEachHashed(const std::uint8_t* rows, std::size_t count, const CountedRows& soon,
                                  Take take) {
    constexpr std::size_t group = 32;
    std::array<std::uint32_t, group> hashes;
    const std::size_t rowBytes = layout_.rowBytes();
    for (std::size_t first = 0; first < count; first += group) {
        const std::size_t size = std::min(group, count - first);
        for (std::size_t i = 0; i < size; ++i) {
            hashes[i] = CountedRows::hashOf(rows + (first + i) * rowBytes, rowBytes);
            soon.prefetch(hashes[i]);
        }
        for (std::size_t i = 0; i < size; ++i)
            take(rows + (first + i) * rowBytes, hashes[i]);
    }
}

void PointComparer::addFile(const std::uint8_t* rows, std::size_t count) {
    result_.filePoints += count;
    forEachHashed(rows, count, file_,
                  [&](const std::uint8_t* row, std::uint32_t hash) { file_.add(row, hash); });
}

void PointComparer::addInput(const std::uint8_t* rows, std::size_t count) {
    result_.inputPoints += count;
    forEachHashed(rows, count, file_, [&](const std::uint8_t* row, std::uint32_t hash) {
        if (file_.take(row, hash))
            ++result_.equalPoints;
        else
            missing_.add(row, hash);
    });
}

Comparison PointComparer::finish() {
    compareRest();
    keepFirst(result_.first);
    return std::move(result_);
}

std::vector<PointComparer::Rest> PointComparer::sortedRest(const CountedRows& rows) const {
    std::vector<Rest> rest;
    rows.forEach([&](const std::uint8_t* row, std::uint64_t count) {
        rest.push_back({row, layout_.position(row), count});
    });
    std::sort(rest.begin(), rest.end(), [&](const Rest& a, const Rest& b) {
        int order = compareMorton(a.position, b.position);
        return order != 0 ? order < 0
                          : std::memcmp(layout_.attributes(a.row), layout_.attributes(b.row),
                                        layout_.attributeBytes()) < 0;
    });
    return rest;
}

// What found no equal, in Morton order: points at one position are paired, as far as there are two.
void PointComparer::compareRest() {
    std::vector<Rest> file = sortedRest(file_), input = sortedRest(missing_);
    for (std::size_t f = 0, i = 0; f < file.size() || i < input.size();) {
        int order = f == file.size()    ? 1
                    : i == input.size() ? -1
                                        : compareMorton(file[f].position, input[i].position);
        if (order < 0) {
            noteSurplus(file[f], file[f].count);
            ++f;
        } else if (order > 0) {
            noteMissing(input[i], input[i].count);
            ++i;
        } else {
            std::uint64_t pairs = std::min(file[f].count, input[i].count);
            noteChanged(file[f], input[i], pairs);
            f += (file[f].count -= pairs) == 0 ? 1 : 0;
            i += (input[i].count -= pairs) == 0 ? 1 : 0;
        }
    }
}

void PointComparer::noteChanged(const Rest& file, const Rest& input, std::uint64_t count) {
    result_.changed += count;
    std::string differences;
    const std::uint8_t *ours = layout_.attributes(file.row), *theirs = layout_.attributes(input.row);
    for (std::size_t a = 0; a < layout_.schema().attributes.size(); ++a) {
        const Attribute& attribute = layout_.schema().attributes[a];
        if (std::memcmp(ours, theirs, attribute.size()) != 0) {
            result_.changedPerAttribute[a] += count;
            if (result_.first.size() < Comparison::mostDifferences)
                differences += cat(differences.empty() ? "" : ", ", attribute.name, " is ",
                                   valueText(attribute, ours), ", not ", valueText(attribute, theirs));
        }
        ours += attribute.size();
        theirs += attribute.size();
    }
    say(file.position, differences, count);
}

void PointComparer::noteSurplus(const Rest& file, std::uint64_t count) {
    result_.surplus += count;
    say(file.position, "the file has a point that is not in the inputs", count);
}

void PointComparer::noteMissing(const Rest& input, std::uint64_t count) {
    result_.missing += count;
    say(input.position, missingText, count);
}

void PointComparer::say(Vec3i position, const std::string& what, std::uint64_t count) {
    if (result_.first.size() < Comparison::mostDifferences)
        result_.first.push_back(difference(grid_, position, what, count));
}

} // namespace stipple
