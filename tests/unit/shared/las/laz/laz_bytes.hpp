// LAZ files laid out for tests: of any compressor, item versions, chunk sizes and chunk table.
#pragma once

#include "shared/las/laz/chunk_table.hpp"
#include "shared/las/laz/laszip_record.hpp"
#include "shared/las/laz/layered_chunk.hpp"
#include "shared/las/laz/pointwise_codec.hpp"
#include "tests/unit/shared/las/las_bytes.hpp"

namespace stipple::test {

// Like records of a scanner's flight: small steps, few values, some jumps.
inline Bytes smoothRecords(int pointFormat, std::size_t extraBytes, std::size_t count,
                           std::uint32_t seed = 1) {
    std::mt19937 random(seed);
    const std::size_t base = las::pointRecordSize(pointFormat), length = base + extraBytes;
    Bytes records(count * length);
    std::array<std::int32_t, 3> at{-50000, 123456, 1000};
    std::uint64_t time = 0x4112345678000000;
    std::uint64_t waveOffset = 60;
    const bool layered = pointFormat >= 6;
    const std::size_t timeAt = layered ? 22 : 20;
    const bool hasTime = layered || pointFormat == 1 || pointFormat >= 3;
    const bool hasWave = pointFormat == 4 || pointFormat == 5 || pointFormat >= 9;
    for (std::size_t i = 0; i < count; ++i) {
        std::uint8_t* record = records.data() + i * length;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            at[axis] += static_cast<std::int32_t>(random() % 200) - 90;
            storeLe(record + 4 * axis, at[axis]);
        }
        storeLe(record + 12, static_cast<std::uint16_t>(200 + random() % 30));
        const unsigned returns = random() % 4 == 0 ? 3 : 1, number = 1 + static_cast<unsigned>(i) % returns;
        const unsigned flags = number | returns << (layered ? 4 : 3) | (layered ? 0 : (i / 100 % 2) << 6);
        record[14] = static_cast<std::uint8_t>(flags);
        record[layered ? 16 : 15] = random() % 10 == 0 ? 2 : 5;
        record[layered ? 18 : 16] = static_cast<std::uint8_t>(random() % 3);
        record[17] = static_cast<std::uint8_t>(i / 300);
        storeLe(record + (layered ? 20 : 18), static_cast<std::uint16_t>(17 + i / 500));
        time += random() % 50 == 0 ? 0x900000000 : random() % 3 == 0 ? 0 : 1000 + random() % 10;
        if (hasTime)
            storeLe(record + timeAt, random() % 100 == 0 ? time - 0x800000000 : time);
        const std::size_t colourAt = layered ? 30 : timeAt + (hasTime ? 8 : 0);
        const std::size_t waveAt = base - 29;
        for (std::size_t b = colourAt; b < (hasWave ? waveAt : base); b += 2)
            storeLe(record + b, static_cast<std::uint16_t>((random() % 20 + 80) * (i % 7 == 0 ? 257 : 256)));
        if (hasWave) {
            const std::uint32_t size = random() % 5 == 0 ? 128 : 256;
            record[waveAt] = 1;
            storeLe(record + waveAt + 1, waveOffset);
            storeLe(record + waveAt + 9, size);
            storeLe(record + waveAt + 13, static_cast<float>(random() % 1000));
            for (std::size_t k = 0; k < 3; ++k)
                storeLe(record + waveAt + 17 + 4 * k, 0.001f * static_cast<float>(k + random() % 3));
            waveOffset += random() % 20 == 0 ? 0 : random() % 30 == 0 ? 0x1234567890 : size;
        }
        for (std::size_t b = 0; b < extraBytes; ++b)
            record[base + b] = static_cast<std::uint8_t>(b % 2 == 0 ? i / 64 : random() % 4);
    }
    return records;
}

enum class TablePlace { front, end, absent };

struct LazRecipe {
    LasRecipe las;
    las::laz::LaszipRecord record;               // see lazRecipe()
    std::vector<std::uint32_t> variableChunks{}; // points of each, where they vary
    TablePlace table = TablePlace::front;
};

// As the writer writes it, with chunks of `chunkSize` points.
inline LazRecipe lazRecipe(int pointFormat, std::size_t extraBytes, std::size_t points,
                           std::uint32_t chunkSize) {
    LazRecipe recipe;
    recipe.las = {pointFormat >= 6 ? 4 : pointFormat >= 4 ? 3 : 2, pointFormat, points};
    recipe.las.extraBytes = extraBytes;
    recipe.record = las::laz::laszipRecordFor(pointFormat, las::pointRecordSize(pointFormat) + extraBytes);
    recipe.record.chunkSize = chunkSize;
    return recipe;
}
// As LASzip 1.x did.
inline LazRecipe firstVersion(LazRecipe recipe) {
    for (las::laz::Item& item : recipe.record.items)
        item.version = 1;
    return recipe;
}

inline Bytes encodeChunk(const las::laz::LaszipRecord& record, ByteSpan records) {
    std::unique_ptr<las::laz::ChunkEncoder> encoder;
    if (record.compressor == las::laz::Compressor::layeredChunked) {
        auto layered = las::laz::makeLayeredEncoder(record.items);
        REQUIRE(layered.ok());
        encoder = std::move(*layered);
    } else {
        encoder = las::laz::makePointwiseEncoder(record.items);
    }
    encoder->start();
    encoder->encode(records);
    ByteSpan chunk = encoder->finish();
    return Bytes(chunk.begin(), chunk.end());
}

// What stands between the records and the end of a LAZ file.
inline Bytes encodePoints(const LazRecipe& recipe, const Bytes& records, std::uint64_t offset) {
    const std::size_t length = las::pointRecordSize(recipe.las.pointFormat) + recipe.las.extraBytes;
    if (!recipe.record.isChunked())
        return records.empty() ? Bytes{} : encodeChunk(recipe.record, records);
    Bytes bytes(8, 0xFF);
    std::vector<las::laz::Chunk> chunks;
    for (std::size_t at = 0; at < records.size();) {
        std::size_t size = recipe.record.chunkSize;
        if (recipe.record.hasVariableChunks())
            size = recipe.variableChunks[chunks.size()];
        size = std::min(size * length, records.size() - at);
        Bytes chunk = encodeChunk(recipe.record, ByteSpan(records).subspan(at, size));
        chunks.push_back(
            {static_cast<std::uint32_t>(size / length), static_cast<std::uint32_t>(chunk.size())});
        bytes.insert(bytes.end(), chunk.begin(), chunk.end());
        at += size;
    }
    const std::uint64_t tableOffset = offset + bytes.size();
    if (recipe.table == TablePlace::absent)
        return bytes;
    Bytes table = las::laz::encodeChunkTable(chunks, recipe.record.hasVariableChunks());
    bytes.insert(bytes.end(), table.begin(), table.end());
    if (recipe.table == TablePlace::end)
        bytes.resize(bytes.size() + 8);
    storeLe(recipe.table == TablePlace::end ? bytes.data() + bytes.size() - 8 : bytes.data(), tableOffset);
    return bytes;
}

inline Bytes lazBytes(LazRecipe recipe, const Bytes& records) {
    recipe.las.vlrs.push_back(
        {"laszip encoded", 22204, "", las::laz::encodeLaszipRecord(recipe.record), false});
    Bytes front = lasBytes(recipe.las, {});
    front[atPointFormat] = static_cast<std::uint8_t>(front[atPointFormat] | 0x80);
    Bytes points = encodePoints(recipe, records, front.size());
    front.insert(front.end(), points.begin(), points.end());
    return front;
}

} // namespace stipple::test
