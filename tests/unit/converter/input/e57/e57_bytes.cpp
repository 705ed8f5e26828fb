#include "tests/unit/converter/input/e57/e57_bytes.hpp"

#include "shared/base/text.hpp"

#include <algorithm>

namespace stipple::test {

namespace {
constexpr std::size_t payload = 1020, page = 1024;

std::size_t physical(std::size_t logical) {
    return logical / payload * page + logical % payload;
}

Bytes packed(const E57Field& field, std::size_t begin, std::size_t end) {
    auto bits = static_cast<std::size_t>(field.bits);
    Bytes bytes(((end - begin) * bits + 7) / 8);
    for (std::size_t i = 0; i < (end - begin) * bits; ++i)
        if ((field.codes[begin + i / bits] >> (i % bits) & 1) != 0)
            bytes[i / 8] = static_cast<std::uint8_t>(bytes[i / 8] | 1u << (i % 8));
    return bytes;
}

void writeDataPacket(ByteWriter& out, const std::vector<Bytes>& parts, bool restart) {
    std::size_t size = 6 + 2 * parts.size();
    for (const Bytes& part : parts)
        size += part.size();
    std::size_t padding = (4 - size % 4) % 4;
    out.write<std::uint8_t>(1);
    out.write<std::uint8_t>(restart ? 1 : 0);
    out.write(static_cast<std::uint16_t>(size + padding - 1));
    out.write(static_cast<std::uint16_t>(parts.size()));
    for (const Bytes& part : parts)
        out.write(static_cast<std::uint16_t>(part.size()));
    for (const Bytes& part : parts)
        out.writeBytes(part);
    out.writeBytes(Bytes(padding));
}

void writeIgnoredPackets(ByteWriter& out, std::size_t fields) {
    out.writeBytes(Bytes{2, 0, 7, 0, 0xAA, 0xBB, 0xCC, 0xDD}); // empty, 8 bytes
    Bytes index(32);
    index[2] = 31;
    index[4] = 1;
    out.writeBytes(index);
    writeDataPacket(out, std::vector<Bytes>(fields), false); // data packet without data
}

void writePackets(ByteWriter& out, const E57Scan& scan) {
    std::size_t step =
        scan.recordsPerRestart == 0 ? std::max<std::size_t>(scan.records(), 1) : scan.recordsPerRestart;
    for (std::size_t begin = 0; begin < scan.records(); begin += step) {
        std::size_t end = std::min(begin + step, scan.records());
        std::vector<Bytes> streams;
        for (const E57Field& field : scan.fields)
            streams.push_back(packed(field, begin, end));
        bool restart = begin > 0 || scan.flagFirst, more = true;
        while (more) {
            std::vector<Bytes> parts;
            more = false;
            for (Bytes& stream : streams) {
                auto cut = stream.begin() +
                           static_cast<std::ptrdiff_t>(std::min(stream.size(), scan.bytesPerPacket));
                parts.emplace_back(stream.begin(), cut);
                stream.erase(stream.begin(), cut);
                more = more || !stream.empty();
            }
            if (scan.emptyPackets)
                writeIgnoredPackets(out, scan.fields.size());
            writeDataPacket(out, parts, restart);
            restart = false;
        }
    }
}

std::string scanXml(const E57Scan& scan, std::size_t section) {
    std::string prototype;
    for (const E57Field& field : scan.fields)
        prototype += field.xml;
    long long records =
        scan.claimedRecords >= 0 ? scan.claimedRecords : static_cast<long long>(scan.records());
    return cat("<vectorChild type=\"Structure\">", scan.xml,
               "<points type=\"CompressedVector\" fileOffset=\"", physical(section), "\" recordCount=\"",
               records, "\"><prototype type=\"Structure\">", prototype, "</prototype>", scan.codecs,
               "</points></vectorChild>");
}
} // namespace

E57Field integerField(const std::string& name, std::int64_t minimum, std::int64_t maximum,
                      const std::vector<std::int64_t>& values, const std::string& attributes) {
    E57Field field;
    field.xml = cat("<", name, " type=\"", attributes.empty() ? "Integer" : "ScaledInteger", "\" minimum=\"",
                    minimum, "\" maximum=\"", maximum, "\"", attributes, "/>");
    std::uint64_t range = static_cast<std::uint64_t>(maximum) - static_cast<std::uint64_t>(minimum);
    for (field.bits = 0; field.bits < 64 && range >> field.bits != 0; ++field.bits) {
    }
    for (std::int64_t value : values)
        field.codes.push_back(static_cast<std::uint64_t>(value) - static_cast<std::uint64_t>(minimum));
    return field;
}

E57Field scaledField(const std::string& name, std::int64_t minimum, std::int64_t maximum,
                     const std::string& scale, const std::string& offset,
                     const std::vector<std::int64_t>& values) {
    return integerField(name, minimum, maximum, values,
                        cat(" scale=\"", scale, "\" offset=\"", offset, "\""));
}

E57Field floatField(const std::string& name, const std::vector<float>& values) {
    E57Field field{cat("<", name, " type=\"Float\" precision=\"single\"/>"), 32, {}};
    for (float value : values)
        field.codes.push_back(bitCast<std::uint32_t>(value));
    return field;
}

E57Field doubleField(const std::string& name, const std::vector<double>& values) {
    E57Field field{cat("<", name, " type=\"Float\"/>"), 64, {}};
    for (double value : values)
        field.codes.push_back(bitCast<std::uint64_t>(value));
    return field;
}

Bytes E57File::bytes() const {
    ByteWriter out;
    out.writeBytes(Bytes(48));
    std::string scansXml;
    for (const E57Scan& scan : scans) {
        out.writeBytes(Bytes((4 - out.size() % 4) % 4));
        if (out.size() % payload > payload - 32) // the reader must join pages, but offsets stay readable
            out.writeBytes(Bytes(payload - out.size() % payload));
        std::size_t section = out.size();
        out.writeBytes(Bytes(32));
        writePackets(out, scan);
        Bytes& bytes = out.bytes();
        bytes[section] = 1;
        storeLe<std::uint64_t>(bytes.data() + section + 8, bytes.size() - section);
        storeLe<std::uint64_t>(bytes.data() + section + 16, physical(section + 32));
        scansXml += scanXml(scan, section);
    }
    std::size_t xmlAt = out.size();
    std::string xml = cat("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<e57Root type=\"Structure\" "
                          "xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\">",
                          rootXml, "<data3D type=\"Vector\" allowHeterogeneousChildren=\"1\">", scansXml,
                          "</data3D></e57Root>");
    out.writeBytes({reinterpret_cast<const std::uint8_t*>(xml.data()), xml.size()});
    Bytes& bytes = out.bytes();
    std::size_t pages = (bytes.size() + payload - 1) / payload;
    std::memcpy(bytes.data(), "ASTM-E57", 8);
    storeLe<std::uint32_t>(bytes.data() + 8, 1);
    storeLe<std::uint64_t>(bytes.data() + 16, pages * page);
    storeLe<std::uint64_t>(bytes.data() + 24, physical(xmlAt));
    storeLe<std::uint64_t>(bytes.data() + 32, xml.size());
    storeLe<std::uint64_t>(bytes.data() + 40, page);
    return e57Pages(bytes);
}

Bytes e57Pages(const Bytes& logical) {
    Bytes file;
    for (std::size_t at = 0; at < logical.size(); at += payload) {
        auto begin = logical.begin() + static_cast<std::ptrdiff_t>(at);
        file.insert(file.end(), begin,
                    begin + static_cast<std::ptrdiff_t>(std::min(payload, logical.size() - at)));
        file.resize((file.size() + page - 1) / page * page);
    }
    mendE57Checksums(file);
    return file;
}

void mendE57Checksums(Bytes& file) {
    for (std::size_t at = 0; at + page <= file.size(); at += page) {
        std::uint32_t crc = slowCrc32c({file.data() + at, payload});
        for (std::size_t i = 0; i < 4; ++i)
            file[at + payload + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
    }
}

std::uint32_t slowCrc32c(ByteSpan bytes) {
    std::uint32_t rest = ~0u;
    for (std::uint8_t byte : bytes) {
        rest ^= byte;
        for (int bit = 0; bit < 8; ++bit)
            rest = (rest >> 1) ^ ((rest & 1) != 0 ? 0x82F63B78u : 0u);
    }
    return ~rest;
}

} // namespace stipple::test
