#include "shared/las/laz/chunk_table.hpp"

#include "shared/base/text.hpp"
#include "shared/las/laz/coding.hpp"

#include <memory>

namespace stipple::las::laz {

namespace {

using Numbers = IntegerCompressor<32, 2>; // context 0: points, 1: bytes

template <class Coder>
void codeChunk(Coder& coder, Numbers& numbers, bool variable, const Chunk& last, Chunk& chunk) {
    auto code = [&](std::uint32_t before, std::uint32_t now, unsigned context) {
        return static_cast<std::uint32_t>(codeInteger(coder, numbers, static_cast<std::int32_t>(before),
                                                      static_cast<std::int32_t>(now), context));
    };
    if (variable)
        chunk.points = code(last.points, chunk.points, 0);
    chunk.bytes = code(last.bytes, chunk.bytes, 1);
}

Error damaged(ErrorCode code, std::string what) {
    return {code, cat("the chunk table ", std::move(what)), "", ""};
}

} // namespace

Result<std::vector<Chunk>> parseChunkTable(ByteSpan bytes, bool variable, std::uint64_t mostChunks) {
    ByteReader reader(bytes);
    auto version = reader.read<std::uint32_t>();
    auto count = reader.read<std::uint32_t>();
    if (!reader.ok())
        return damaged(ErrorCode::truncated, cat("ends after ", bytes.size(), " bytes"));
    if (version != 0)
        return damaged(ErrorCode::unsupported, cat("has the version ", version, ", which is not known"));
    if (count > mostChunks)
        return damaged(ErrorCode::corrupt,
                       cat("lists ", count, " chunks, more than the ", mostChunks, " there is room for"));
    std::vector<Chunk> chunks;
    if (count == 0)
        return chunks;
    // With room behind for what is read beyond the end of damaged streams.
    Bytes stream(bytes.begin() + chunkTableHeadSize, bytes.end());
    const std::size_t size = stream.size();
    stream.resize(size + 64);
    ArithmeticDecoder decoder(stream.data());
    auto numbers = std::make_unique<Numbers>();
    numbers->init();
    Chunk last;
    for (std::uint32_t i = 0; i < count; ++i) {
        codeChunk(decoder, *numbers, variable, last, last);
        if (decoder.position() > stream.data() + size)
            return damaged(ErrorCode::truncated, cat("ends after ", i, " of ", count, " chunks"));
        chunks.push_back(last);
    }
    return chunks;
}

Bytes encodeChunkTable(const std::vector<Chunk>& chunks, bool variable) {
    ByteWriter writer;
    writer.write(std::uint32_t{0});
    writer.write(static_cast<std::uint32_t>(chunks.size()));
    if (chunks.empty())
        return writer.take();
    EncodedStream stream;
    stream.start();
    auto numbers = std::make_unique<Numbers>();
    numbers->init();
    Chunk last;
    for (Chunk chunk : chunks) {
        stream.ensureRoom(2 * Numbers::maxBytes);
        codeChunk(stream.encoder, *numbers, variable, last, chunk);
        last = chunk;
    }
    writer.writeBytes(stream.finish());
    return writer.take();
}

} // namespace stipple::las::laz
