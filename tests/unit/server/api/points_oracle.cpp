#include "tests/unit/server/api/points_oracle.hpp"

#include "server/http/target.hpp"
#include "shared/io/memory_source.hpp"

#include <sstream>

namespace stipple::test {

SmallCloudOptions quarterTown() {
    SmallCloudOptions options;
    options.levels = 4;
    options.grid = {{0.25, 0.25, 0.25}, {500000, 4000000, 0}};
    options.rootCube = {{-300, -200, 0}, 12};
    return options;
}

EveryPoint::EveryPoint(const Bytes& file) {
    MemorySource source(file);
    auto reader = CloudReader::open(source);
    REQUIRE(reader.ok());
    metadata = (*reader)->metadata();
    points.resize(metadata.schema, 0);
    Status visited = (*reader)->visitNodes([&](const NodeEntry& entry) -> Status {
        auto node = (*reader)->readNode(entry);
        REQUIRE(node.ok());
        points.positions.insert(points.positions.end(), node->positions.begin(), node->positions.end());
        for (std::size_t a = 0; a < points.columns.size(); ++a)
            points.columns[a].insert(points.columns[a].end(), node->columns[a].begin(),
                                     node->columns[a].end());
        for (std::uint32_t i = 0; i < node->size(); ++i) {
            nodes.push_back(entry.key);
            indices.push_back(i);
        }
        return {};
    });
    REQUIRE(visited.ok());
}

double EveryPoint::value(const std::string& attribute, std::size_t i) const {
    return points.value<std::uint16_t>(metadata.schema.find(attribute), i);
}

PointBatch EveryPoint::where(const std::function<bool(std::size_t)>& wanted) const {
    PointBatch rows;
    rows.columns.resize(points.columns.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!wanted(i))
            continue;
        rows.positions.push_back(points.positions[i]);
        for (std::size_t a = 0; a < rows.columns.size(); ++a) {
            std::size_t size = metadata.schema.attributes[a].size();
            const std::uint8_t* from = points.columns[a].data() + i * size;
            rows.columns[a].insert(rows.columns[a].end(), from, from + size);
        }
    }
    return rows;
}

PointBatch LasAnswer::columnsOf(const Schema& names) const {
    PointBatch chosen;
    chosen.positions = points.positions;
    for (const Attribute& attribute : names.attributes) {
        int column = schema.find(attribute.name);
        REQUIRE(column >= 0);
        chosen.columns.push_back(points.columns[static_cast<std::size_t>(column)]);
    }
    return chosen;
}

LasAnswer lasOf(const std::string& body) {
    MemorySource source(Bytes(body.begin(), body.end()));
    auto reader = las::Reader::open(source);
    INFO((reader.ok() ? "" : reader.error().sentence()));
    REQUIRE(reader.ok());
    CHECK((*reader)->warnings().empty());
    LasAnswer answer{(*reader)->header(), (*reader)->schema(), {}};
    REQUIRE((*reader)->read(0, (*reader)->pointCount(), answer.points).ok());
    REQUIRE(answer.points.size() == answer.header.pointCount);
    return answer;
}

std::vector<std::vector<std::string>> csvRows(const std::string& body) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(body);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream fields(line);
        rows.emplace_back();
        for (std::string field; std::getline(fields, field, ',');)
            rows.back().push_back(field);
    }
    return rows;
}

std::string plyHeader(const std::string& body) {
    std::size_t end = body.find("end_header\n");
    REQUIRE(end != std::string::npos);
    return body.substr(0, end + 11);
}

bool operator==(const PointBatch& a, const PointBatch& b) {
    return a.positions == b.positions && a.columns == b.columns;
}

std::string encoded(const std::string& text) {
    return server::percentEncoded(text);
}

} // namespace stipple::test
