#include "shared/las/laz/laszip_record.hpp"

#include "shared/base/text.hpp"

namespace stipple::las::laz {

namespace {

constexpr std::size_t fixedSize = 34, itemSize = 6;

Error refuse(ErrorCode code, std::string what) {
    return {code, std::move(what), "the \"laszip encoded\" record",
            "write the file again with a current LASzip"};
}

const char* nameOf(ItemType type) {
    switch (type) {
    case ItemType::byte:
        return "BYTE";
    case ItemType::point10:
        return "POINT10";
    case ItemType::gpsTime11:
        return "GPSTIME11";
    case ItemType::rgb12:
        return "RGB12";
    case ItemType::wavePacket13:
        return "WAVEPACKET13";
    case ItemType::point14:
        return "POINT14";
    case ItemType::rgb14:
        return "RGB14";
    case ItemType::rgbNir14:
        return "RGBNIR14";
    case ItemType::wavePacket14:
        return "WAVEPACKET14";
    case ItemType::byte14:
        return "BYTE14";
    }
    return "of unknown type";
}

// The items that a point format's records consist of, without versions.
Items itemsOf(int pointFormat, std::size_t recordLength) {
    const bool layered = pointFormat >= 6;
    Items items;
    std::size_t size = 0;
    auto add = [&](ItemType type, std::size_t bytes) {
        items.push_back({type, static_cast<std::uint16_t>(bytes), 0});
        size += bytes;
    };
    if (layered) {
        add(ItemType::point14, 30);
        if (pointFormat == 7)
            add(ItemType::rgb14, 6);
        if (pointFormat == 8 || pointFormat == 10)
            add(ItemType::rgbNir14, 8);
        if (pointFormat >= 9)
            add(ItemType::wavePacket14, 29);
    } else {
        add(ItemType::point10, 20);
        if (pointFormat != 0 && pointFormat != 2)
            add(ItemType::gpsTime11, 8);
        if (pointFormat == 2 || pointFormat == 3 || pointFormat == 5)
            add(ItemType::rgb12, 6);
        if (pointFormat >= 4)
            add(ItemType::wavePacket13, 29);
    }
    if (recordLength > size)
        add(layered ? ItemType::byte14 : ItemType::byte, recordLength - size);
    return items;
}

bool isKnownVersion(const Item& item) {
    if (item.type >= ItemType::point14)
        return item.version == 3 || item.version == 4;
    if (item.type == ItemType::wavePacket13)
        return item.version == 1;
    return item.version == 1 || item.version == 2;
}

Status checkItems(const Items& items, int pointFormat, std::size_t recordLength) {
    const Items expected = itemsOf(pointFormat, recordLength);
    std::size_t total = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const Item& item = items[i];
        total += item.sizeBytes;
        if (i >= expected.size() || item.type != expected[i].type)
            return refuse(ErrorCode::corrupt,
                          cat("item ", i, " is ", nameOf(item.type), " (type ",
                              static_cast<unsigned>(item.type), "), which records of point format ",
                              pointFormat, " of ", recordLength, " bytes do not have there"));
        if (item.sizeBytes != expected[i].sizeBytes)
            return refuse(ErrorCode::corrupt,
                          cat("item ", i, " (", nameOf(item.type), ") has ", item.sizeBytes,
                              " bytes, but records of point format ", pointFormat, " of ", recordLength,
                              " bytes have ", expected[i].sizeBytes, " there"));
        if (!isKnownVersion(item))
            return refuse(ErrorCode::unsupported, cat("item ", i, " (", nameOf(item.type), ") has version ",
                                                      item.version, ", which is not known"));
        if (item.type >= ItemType::point14 && item.version != items[0].version)
            return refuse(ErrorCode::corrupt,
                          cat("layered items have the versions ", items[0].version, " and ", item.version));
    }
    if (items.size() != expected.size())
        return refuse(ErrorCode::corrupt,
                      cat("its items cover ", total, " of the ", recordLength, " bytes of a point record"));
    return {};
}

} // namespace

Result<LaszipRecord> parseLaszipRecord(ByteSpan data, int pointFormat, std::size_t recordLength) {
    ByteReader reader(data);
    LaszipRecord record;
    auto compressor = reader.read<std::uint16_t>();
    auto coder = reader.read<std::uint16_t>();
    record.versionMajor = reader.read<std::uint8_t>();
    record.versionMinor = reader.read<std::uint8_t>();
    record.versionRevision = reader.read<std::uint16_t>();
    record.options = reader.read<std::uint32_t>();
    record.chunkSize = reader.read<std::uint32_t>();
    reader.skip(16);
    auto itemCount = reader.read<std::uint16_t>();
    if (!reader.ok() || reader.remaining() < itemCount * itemSize)
        return refuse(ErrorCode::truncated, cat("it has ", data.size(), " bytes, but needs ",
                                                fixedSize + (reader.ok() ? itemCount * itemSize : 0)));
    if (compressor < 1 || compressor > 3)
        return refuse(ErrorCode::unsupported, cat("compressor ", compressor, " is not known (1 to 3 are)"));
    record.compressor = static_cast<Compressor>(compressor);
    if (coder != 0)
        return refuse(ErrorCode::unsupported,
                      cat("coder ", coder, " is not known (0, arithmetic coding, is the only one)"));
    for (unsigned i = 0; i < itemCount; ++i) {
        Item item;
        item.type = static_cast<ItemType>(reader.read<std::uint16_t>());
        item.sizeBytes = reader.read<std::uint16_t>();
        item.version = reader.read<std::uint16_t>();
        record.items.push_back(item);
    }
    STIPPLE_CHECK(checkItems(record.items, pointFormat, recordLength));
    if ((record.compressor == Compressor::layeredChunked) != (pointFormat >= 6))
        return refuse(ErrorCode::corrupt,
                      cat("compressor ", compressor, " does not go with point format ", pointFormat));
    if (record.isChunked() && record.chunkSize == 0)
        return refuse(ErrorCode::corrupt, "its chunks hold 0 points");
    return record;
}

Bytes encodeLaszipRecord(const LaszipRecord& record) {
    ByteWriter writer;
    writer.write(static_cast<std::uint16_t>(record.compressor));
    writer.write(std::uint16_t{0}); // arithmetic coding
    writer.write(record.versionMajor);
    writer.write(record.versionMinor);
    writer.write(record.versionRevision);
    writer.write(record.options);
    writer.write(record.chunkSize);
    writer.write(std::int64_t{-1}); // no special extended records
    writer.write(std::int64_t{-1});
    writer.write(static_cast<std::uint16_t>(record.items.size()));
    for (const Item& item : record.items) {
        writer.write(static_cast<std::uint16_t>(item.type));
        writer.write(item.sizeBytes);
        writer.write(item.version);
    }
    return writer.take();
}

LaszipRecord laszipRecordFor(int pointFormat, std::size_t recordLength) {
    LaszipRecord record;
    record.compressor = pointFormat >= 6 ? Compressor::layeredChunked : Compressor::pointwiseChunked;
    record.items = itemsOf(pointFormat, recordLength);
    for (Item& item : record.items)
        item.version = pointFormat >= 6 ? 3 : item.type == ItemType::wavePacket13 ? 1 : 2;
    return record;
}

} // namespace stipple::las::laz
