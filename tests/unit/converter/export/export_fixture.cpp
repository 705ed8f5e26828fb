#include "tests/unit/converter/export/export_fixture.hpp"

#include "shared/io/file_source.hpp"

#include <sstream>

namespace stipple::test {

AllPoints allPoints(const std::string& path) {
    auto source = need(openFileSource(path));
    auto reader = need(CloudReader::open(*source));
    AllPoints all;
    all.metadata = reader->metadata();
    all.points.resize(all.metadata.schema, 0);
    Status visited = reader->visitNodes([&](const NodeEntry& entry) -> Status {
        PointBatch batch = need(reader->readNode(entry));
        all.points.positions.insert(all.points.positions.end(), batch.positions.begin(),
                                    batch.positions.end());
        for (std::size_t a = 0; a < batch.columns.size(); ++a)
            all.points.columns[a].insert(all.points.columns[a].end(), batch.columns[a].begin(),
                                         batch.columns[a].end());
        all.nodes.insert(all.nodes.end(), batch.size(), entry);
        return {};
    });
    REQUIRE(visited.ok());
    return all;
}

LasContent readLas(const std::string& path) {
    auto source = need(openFileSource(path));
    auto reader = need(las::Reader::open(*source));
    LasContent content{reader->header(), reader->schema(), {}};
    CHECK(reader->warnings().empty());
    REQUIRE(reader->read(0, reader->pointCount(), content.points).ok());
    REQUIRE(content.points.size() == content.header.pointCount);
    return content;
}

CsvContent readCsv(const std::string& text) {
    CsvContent content;
    std::vector<std::string> row;
    std::string field;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        char c = text[i];
        if (quoted) {
            if (c != '"')
                field += c;
            else if (i + 1 < text.size() && text[i + 1] == '"')
                field += text[++i];
            else
                quoted = false;
        } else if (c == '"') {
            quoted = true;
        } else if (c == ',' || c == '\n') {
            row.push_back(field);
            field.clear();
            if (c == '\n') {
                content.rows.push_back(row);
                row.clear();
            }
        } else {
            field += c;
        }
    }
    REQUIRE(field.empty()); // the last line ends too
    REQUIRE_FALSE(content.rows.empty());
    content.names = content.rows.front();
    content.rows.erase(content.rows.begin());
    for (const auto& each : content.rows)
        REQUIRE(each.size() == content.names.size());
    return content;
}

namespace {
template <class T>
double numberAt(const std::string& text, std::size_t& at) {
    REQUIRE(at + sizeof(T) <= text.size());
    T value;
    std::memcpy(&value, text.data() + at, sizeof value);
    at += sizeof value;
    return static_cast<double>(value);
}

double plyNumber(const std::string& type, const std::string& text, std::size_t& at) {
    if (type == "char")
        return numberAt<std::int8_t>(text, at);
    if (type == "uchar")
        return numberAt<std::uint8_t>(text, at);
    if (type == "short")
        return numberAt<std::int16_t>(text, at);
    if (type == "ushort")
        return numberAt<std::uint16_t>(text, at);
    if (type == "int")
        return numberAt<std::int32_t>(text, at);
    if (type == "uint")
        return numberAt<std::uint32_t>(text, at);
    if (type == "float")
        return numberAt<float>(text, at);
    REQUIRE(type == "double");
    return numberAt<double>(text, at);
}
} // namespace

PlyContent readPly(const std::string& text) {
    PlyContent content;
    const std::string end = "end_header\n";
    std::size_t at = text.find(end);
    REQUIRE(at != std::string::npos);
    std::istringstream header(text.substr(0, at));
    at += end.size();
    std::string line;
    std::getline(header, line);
    REQUIRE(line == "ply");
    std::getline(header, line);
    REQUIRE(line == "format binary_little_endian 1.0");
    while (std::getline(header, line)) {
        std::istringstream words(line);
        std::string word, type, name, more;
        words >> word;
        if (word == "comment") {
            content.comments.push_back(line);
            continue;
        }
        if (word == "element") {
            words >> name >> content.count;
            REQUIRE(name == "vertex");
            continue;
        }
        REQUIRE(word == "property");
        words >> type >> name;
        REQUIRE_FALSE(words >> more);
        content.types.push_back(type);
        content.names.push_back(name);
        REQUIRE(content.values.emplace(name, std::vector<double>()).second);
    }
    for (std::size_t i = 0; i < content.count; ++i)
        for (std::size_t p = 0; p < content.names.size(); ++p)
            content.values[content.names[p]].push_back(plyNumber(content.types[p], text, at));
    REQUIRE(at == text.size());
    return content;
}

std::int64_t decimalDigits(const std::string& text, int places) {
    std::size_t point = text.find('.');
    std::size_t found = point == std::string::npos ? 0 : text.size() - point - 1;
    INFO(text);
    REQUIRE(found == static_cast<std::size_t>(places));
    std::string digits = text;
    if (point != std::string::npos)
        digits.erase(point, 1);
    return std::stoll(digits);
}

void requireEqual(const PointBatch& a, const PointBatch& b) {
    REQUIRE(a.size() == b.size());
    REQUIRE(a.positions == b.positions);
    REQUIRE(a.columns.size() == b.columns.size());
    for (std::size_t i = 0; i < a.columns.size(); ++i) {
        INFO("column " << i);
        REQUIRE((a.columns[i] == b.columns[i]));
    }
}

SmallCloudFile::SmallCloudFile(const SmallCloudOptions& options) : cloud(makeSmallCloud(options)) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(cloud.file.data()),
               static_cast<std::streamsize>(cloud.file.size()));
}

ExportResult exportOrFail(const std::string& input, const std::string& output, const ExportOptions& options) {
    auto result = exportFile(input, output, options, noProgress);
    if (!result)
        FAIL(result.error().sentence());
    return std::move(result).value();
}

std::string textOf(const std::string& path) {
    Bytes bytes = fileBytes(path);
    return std::string(bytes.begin(), bytes.end());
}

} // namespace stipple::test
