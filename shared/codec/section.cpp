#define ZSTD_STATIC_LINKING_ONLY
#include "shared/codec/section.hpp"

#include "shared/base/text.hpp"
#include "shared/codec/varint.hpp"

#include <memory>
#include <zstd.h>

namespace stipple {

namespace {

struct FreeContext {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

void setUp(ZSTD_CCtx* context, Effort effort) {
    constexpr int literalsLevel = -100; // the faster the level, the fewer string matches are found: none
    int level = effort == Effort::literals ? literalsLevel : effort == Effort::fast ? 1 : 6;
    ZSTD_CCtx_reset(context, ZSTD_reset_session_and_parameters);
    ZSTD_CCtx_setParameter(context, ZSTD_c_format, ZSTD_f_zstd1_magicless);
    ZSTD_CCtx_setParameter(context, ZSTD_c_compressionLevel, level);
    if (effort == Effort::literals)
        ZSTD_CCtx_setParameter(context, ZSTD_c_literalCompressionMode, ZSTD_ps_enable);
}

ZSTD_CCtx* compressor() {
    thread_local std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
    return context.get();
}

ZSTD_DCtx* decompressor() {
    thread_local std::unique_ptr<ZSTD_DCtx, FreeContext> context = [] {
        std::unique_ptr<ZSTD_DCtx, FreeContext> made(ZSTD_createDCtx());
        ZSTD_DCtx_setParameter(made.get(), ZSTD_d_format, ZSTD_f_zstd1_magicless);
        return made;
    }();
    return context.get();
}

} // namespace

void writeSection(ByteWriter& to, ByteSpan content, Effort effort) {
    thread_local Bytes frame;
    frame.resize(ZSTD_compressBound(content.size()));
    setUp(compressor(), effort);
    std::size_t size =
        ZSTD_compress2(compressor(), frame.data(), frame.size(), content.data(), content.size());
    bool compressed = !ZSTD_isError(size) && size < content.size();
    ByteSpan stored = compressed ? ByteSpan(frame).first(size) : content;
    writeVarint(to, 2 * stored.size() + (compressed ? 1 : 0));
    to.writeBytes(stored);
}

Result<std::size_t> readSection(ByteReader& from, std::span<std::uint8_t> room) {
    std::uint64_t word = readVarint(from);
    ByteSpan stored = from.readBytes(static_cast<std::size_t>(std::min<std::uint64_t>(word / 2, SIZE_MAX)));
    if (!from.ok())
        return Error{ErrorCode::truncated, say("a section ends early"), {}, {}};
    if (word % 2 == 0) {
        if (stored.size() > room.size())
            return Error{ErrorCode::corrupt,
                         say("a section holds ", stored.size(), " bytes where at most ", room.size(), " fit"),
                         {},
                         {}};
        std::copy(stored.begin(), stored.end(), room.begin());
        return stored.size();
    }
    std::size_t size =
        ZSTD_decompressDCtx(decompressor(), room.data(), room.size(), stored.data(), stored.size());
    if (ZSTD_isError(size))
        return Error{ErrorCode::corrupt, say("zstd refuses a section: ", ZSTD_getErrorName(size)), {}, {}};
    return size;
}

Status readFullSection(ByteReader& from, std::span<std::uint8_t> room) {
    STIPPLE_TRY(size, readSection(from, room));
    if (size != room.size())
        return Error{
            ErrorCode::corrupt, say("a section holds ", size, " bytes instead of ", room.size()), {}, {}};
    return {};
}

} // namespace stipple
