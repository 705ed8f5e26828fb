// A small writer of E57 files, for tests: every layout of packets that the standard allows, none of them by
// the reader's own code.
#pragma once

#include "shared/base/bytes.hpp"

#include <string>
#include <vector>

namespace stipple::test {

struct E57Field {
    std::string xml;                  // "<cartesianX type=\"Float\"/>"
    int bits = 64;                    // per record, 0..64
    std::vector<std::uint64_t> codes; // of each record: the integer less the minimum, or a float's bits
};

E57Field integerField(const std::string& name, std::int64_t minimum, std::int64_t maximum,
                      const std::vector<std::int64_t>& values, const std::string& attributes = "");
E57Field scaledField(const std::string& name, std::int64_t minimum, std::int64_t maximum,
                     const std::string& scale, const std::string& offset,
                     const std::vector<std::int64_t>& values);
E57Field floatField(const std::string& name, const std::vector<float>& values);
E57Field doubleField(const std::string& name, const std::vector<double>& values);

struct E57Scan {
    std::vector<E57Field> fields;
    std::string xml; // more of the scan: its name, pose, limits
    // Of each stream a packet has this many bytes at most, so streams of narrow fields run ahead.
    std::size_t bytesPerPacket = 4096;
    bool emptyPackets = false; // between data packets: ignored ones, index packets, data packets of no bytes
    // The streams begin anew after every so many records; 0: never.
    std::size_t recordsPerRestart = 0;
    bool flagFirst = false; // the first packet is flagged as a restart, too
    std::string codecs = "<codecs type=\"Vector\"/>";
    long long claimedRecords = -1; // in the XML, if not those there are

    std::size_t records() const { return fields.empty() ? 0 : fields[0].codes.size(); }
};

struct E57File {
    std::vector<E57Scan> scans;
    std::string rootXml; // more of the root: coordinateMetadata, images2D
    Bytes bytes() const;
};

// Logical bytes cut into pages, each with its checksum.
Bytes e57Pages(const Bytes& logical);
// The file with the checksum of every whole page made right, so that what lies behind is reached.
void mendE57Checksums(Bytes& file);
// Bit by bit, from the definition.
std::uint32_t slowCrc32c(ByteSpan bytes);

} // namespace stipple::test
