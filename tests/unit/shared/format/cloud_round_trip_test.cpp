#include "shared/io/memory_source.hpp"
#include "tests/unit/shared/format/sample_file.hpp"

using namespace stipple;
using namespace stipple::test;

TEST_CASE("the points of a written cloud are read back") {
    SampleFile file = sampleFile(1000);
    MemorySource source(file.bytes);
    auto reader = need(CloudReader::open(source));
    PointHash read;
    std::vector<std::string> nodes;
    need(reader->visitNodes([&](const NodeEntry& entry) -> Status {
        STIPPLE_TRY(batch, reader->readNode(entry));
        read.add(reader->metadata().schema, batch);
        nodes.push_back(entry.key.text());
        return {};
    }));
    CHECK(read == file.hash);
    CHECK(nodes ==
          std::vector<std::string>{"0-0-0-0", "1-0-1-0", "1-1-0-1", "1-1-1-1", "2-2-1-3", "3-5-2-7"});
    CHECK(file.written.nodes == 6);
    CHECK(file.written.fileBytes == file.bytes.size());
    CHECK(file.written.pictureBytes + file.written.attributeBytes + file.written.hierarchyBytes +
              file.written.metadataBytes + fileHeaderBytes ==
          file.bytes.size());
}

TEST_CASE("the same nodes added in another order give the same file") {
    SampleFile file = sampleFile(300, 1);
    CHECK(sampleFile(300, 2).bytes == file.bytes);
    CHECK(sampleFile(300, 3).bytes == file.bytes);
}

TEST_CASE("the first 64 KiB hold the first stratum of the root node") {
    CloudMetadata metadata = sampleMetadata();
    metadata.crs.wkt = std::string(5000, 'x');
    metadata.rootCube.bits = 12; // about the bits a point of a scan
    PointBatch points = randomPoints(metadata, {}, 40000, 1);
    for (auto name : {attribute_names::red, attribute_names::green, attribute_names::blue})
        for (std::size_t i = 0; i < points.size(); ++i)
            points.setValue<std::uint16_t>(metadata.schema.find(name), i, static_cast<std::uint16_t>(i % 32));
    metadata.pointCount = points.size();
    std::string path = temporaryPath("first-request");
    auto writer = need(CloudWriter::create(path));
    need(writer->add(need(encodeNode(metadata, {}, points))));
    need(writer->finish(metadata));
    auto source = need(openFileSource(path));
    Bytes first = need(readNow(*source, {0, firstRequestBytes}));
    auto part = [&](ByteRange range) {
        return ByteSpan(first).subspan(static_cast<std::size_t>(range.offset),
                                       static_cast<std::size_t>(range.size));
    };
    FileHeader header = need(parseFileHeader(first));
    CloudMetadata read = need(parseMetadata(part(header.metadata)));
    auto nodes = need(parseHierarchyChunk(read, header.fileBytes, part(header.rootChunk)));
    ByteRange stratum = nodes[0].strataRange(1);
    REQUIRE(stratum.end() <= firstRequestBytes);
    CHECK(need(decodePicture(read, nodes[0], 1, part(stratum))).size() == 5000);
    std::filesystem::remove(path);
}

TEST_CASE("an empty cloud is a file with an empty root") {
    CloudMetadata metadata = sampleMetadata();
    std::string path = temporaryPath("empty");
    need(need(CloudWriter::create(path))->finish(metadata));
    auto source = need(openFileSource(path));
    auto reader = need(CloudReader::open(*source));
    int nodes = 0;
    need(reader->visitNodes([&](const NodeEntry& entry) -> Status {
        ++nodes;
        CHECK(need(reader->readNode(entry)).size() == 0);
        return {};
    }));
    CHECK(nodes == 1);
    std::filesystem::remove(path);
}

TEST_CASE("without finish nothing is left behind") {
    std::string path = temporaryPath("unfinished"),
                folder = std::filesystem::path(path).parent_path().string();
    {
        auto writer = need(CloudWriter::create(path));
        CloudMetadata metadata = sampleMetadata();
        need(writer->add(need(encodeNode(metadata, {}, randomPoints(metadata, {}, 100, 1)))));
        CHECK(writer->add(need(encodeNode(metadata, {}, randomPoints(metadata, {}, 100, 1)))).error().code ==
              ErrorCode::invalidArgument);       // each key once
        auto refused = writer->finish(metadata); // the count of points is missing
        CHECK(refused.error().code == ErrorCode::invalidArgument);
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        CHECK(entry.path().string().find("stipple-test-unfinished") == std::string::npos);
}

TEST_CASE("a path that cannot be written is an error") {
    auto writer = CloudWriter::create("/nowhere/at/all.stipple");
    REQUIRE(!writer.ok());
    CHECK(writer.error().sentence().find("/nowhere/at/all.stipple") == 0);
}

TEST_CASE("a visitor stops the visit") {
    SampleFile file = sampleFile(10);
    MemorySource source(file.bytes);
    auto reader = need(CloudReader::open(source));
    int nodes = 0;
    Status status = reader->visitNodes([&](const NodeEntry&) -> Status {
        return ++nodes == 2 ? Status(Error{ErrorCode::cancelled, "enough", {}, {}}) : Status{};
    });
    CHECK(status.error().code == ErrorCode::cancelled);
    CHECK(nodes == 2);
}

TEST_CASE("some attributes of a node are read without the bytes of the others") {
    SampleFile file = sampleFile(1000);
    MemorySource source(file.bytes);
    auto reader = need(CloudReader::open(source));
    const CloudMetadata& metadata = reader->metadata();
    int last = static_cast<int>(metadata.schema.attributes.size()) - 1;
    REQUIRE(last >= 3);
    // Each alone, none, and some out of order and twice.
    std::vector<std::vector<int>> asked{{}, {last, 0, last}};
    for (int a = 0; a <= last; ++a)
        asked.push_back({a});
    need(reader->visitNodes([&](const NodeEntry& entry) -> Status {
        PointBatch all = need(reader->readNode(entry));
        for (const std::vector<int>& attributes : asked) {
            NodeBytes bytes = need(reader->fetchNode(entry, attributes));
            std::uint64_t expected = entry.strataRange(strataCount).size;
            for (std::size_t block : blocksHolding(metadata, attributes))
                expected += entry.attributeBytes[block];
            CHECK(bytes.bytes.size() == expected);
            PointBatch some = need(decodeNode(metadata, bytes));
            CHECK(some.positions == all.positions);
            REQUIRE(some.columns.size() == attributes.size());
            for (std::size_t i = 0; i < attributes.size(); ++i)
                CHECK(some.columns[i] == all.columns[static_cast<std::size_t>(attributes[i])]);
        }
        return {};
    }));
}

TEST_CASE("hierarchy chunks below nodes that are not wanted stay unread") {
    SampleFile file = sampleFile(20);
    MemorySource source(file.bytes);
    auto reader = need(CloudReader::open(source));
    std::size_t nodes = 0;
    auto count = [&](bool below) {
        nodes = 0;
        return need(reader->visitWanted([&](const NodeEntry&) -> Result<bool> {
            ++nodes;
            return below;
        }));
    };
    HierarchyCounters all = count(true);
    CHECK(all.chunksSkipped == 0);
    CHECK(all.bytesRead == file.written.hierarchyBytes);
    CHECK(nodes == file.written.nodes);
    HierarchyCounters top = count(false);
    CHECK(top.chunksRead == 1);
    CHECK(top.chunksRead + top.chunksSkipped <= all.chunksRead);
    CHECK(top.bytesRead + top.bytesSkipped <= all.bytesRead);
}
