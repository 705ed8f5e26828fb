#include "client/core/node_normals.hpp"

#include "client/core/resident_node.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace stipple {

namespace {

// Lower case, letters and digits alone.
std::string foldedName(std::string_view name) {
    std::string folded;
    for (unsigned char c : name)
        if (std::isalnum(c))
            folded += static_cast<char>(std::tolower(c));
    return folded;
}

int findFolded(const Schema& schema, std::string_view wanted) {
    for (std::size_t i = 0; i < schema.attributes.size(); ++i)
        if (foldedName(schema.attributes[i].name) == wanted)
            return static_cast<int>(i);
    return -1;
}

std::vector<double> valuesOf(const Schema& schema, int attribute,
                             std::span<const std::shared_ptr<const NodeColumns>> columns) {
    for (const auto& block : columns)
        if (ByteSpan column = block->column(attribute); !column.empty())
            return meaningsOf(schema.attributes[static_cast<std::size_t>(attribute)], column,
                              block->pointCount);
    return {};
}

std::uint32_t signedStep(double value) {
    return static_cast<std::uint32_t>(std::lround(value * 32767)) & 0xFFFFu;
}

} // namespace

std::optional<std::array<int, 3>> normalAttributes(const Schema& schema) {
    for (const char* stem : {"n", "normal", "nornormal"}) {
        std::array<int, 3> found{findFolded(schema, std::string(stem) + "x"),
                                 findFolded(schema, std::string(stem) + "y"),
                                 findFolded(schema, std::string(stem) + "z")};
        if (std::find(found.begin(), found.end(), -1) == found.end())
            return found;
    }
    return std::nullopt;
}

std::uint32_t normalWord(Vec3d normal) {
    double largest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
    bool hasDirection =
        std::isfinite(normal.x) && std::isfinite(normal.y) && std::isfinite(normal.z) && largest > 0;
    if (!hasDirection)
        return noNormalWord;
    Vec3d n{normal.x / largest, normal.y / largest, normal.z / largest}; // sums stay finite, and above zero
    double sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    double x = n.x / sum, y = n.y / sum;
    if (n.z < 0) {
        double left = std::abs(x);
        x = std::copysign(1 - std::abs(y), x);
        y = std::copysign(1 - left, y);
    }
    return signedStep(x) | signedStep(y) << 16;
}

std::shared_ptr<const NodeNormals> packNormals(const Schema& schema,
                                               std::span<const std::shared_ptr<const NodeColumns>> columns) {
    auto attributes = normalAttributes(schema);
    if (!attributes)
        return nullptr;
    std::array<std::vector<double>, 3> values;
    for (std::size_t axis = 0; axis < 3; ++axis)
        values[axis] = valuesOf(schema, (*attributes)[axis], columns);
    std::size_t count = values[0].size();
    if (count == 0 || values[1].size() != count || values[2].size() != count)
        return nullptr;
    auto normals = std::make_shared<NodeNormals>();
    normals->id = nextResidentNodeId();
    normals->words.resize(count);
    for (std::size_t i = 0; i < count; ++i)
        normals->words[i] = normalWord({values[0][i], values[1][i], values[2][i]});
    return normals;
}

} // namespace stipple
