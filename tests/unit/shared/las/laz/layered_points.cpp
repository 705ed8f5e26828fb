#include "tests/unit/shared/las/laz/layered_points.hpp"

#include <algorithm>
#include <cstdlib>

namespace stipple::test {

using namespace las::laz;

Bytes randomRecords(const LayeredCase& of, std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    Bytes records(count * recordLengthOf(itemsOf(of)));
    for (auto& byte : records)
        byte = static_cast<std::uint8_t>(random());
    return records;
}

Bytes scannedRecords(const LayeredCase& of, std::size_t count, unsigned seed, unsigned channels) {
    std::mt19937 random(seed);
    auto below = [&](std::uint32_t limit) { return static_cast<std::uint32_t>(random() % limit); };
    const std::size_t length = recordLengthOf(itemsOf(of));
    Bytes records(count * length);

    std::int32_t x = 1000, y = -5000, z = 300;
    std::array<double, 4> times = {1e5, 1e5 + 7000, 3e8, -12.5};
    unsigned line = 0, returns = 1, next = 1, channel = below(channels);
    std::uint16_t source = 7;
    std::uint8_t classification = 2, userData = 0;
    std::int16_t angle = -3000;
    std::array<std::uint16_t, 4> colour = {100, 200, 300, 400};
    std::uint64_t waveOffset = 60;
    std::uint32_t waveSize = 256;
    for (std::size_t i = 0; i < count; ++i) {
        if (next > returns) { // a new pulse
            returns = below(4) ? 1 + below(3) : below(16);
            next = below(20) ? 1 : below(16);
            if (below(8) == 0)
                channel = below(channels);
            if (below(50) == 0)
                line = below(4);
            const std::uint32_t kind = below(40);
            times[line] += kind == 0   ? -1e-5 * below(20)
                           : kind == 1 ? 1e-6 * below(1000)
                           : kind == 2 ? 1e-3 * below(1000)
                           : kind == 3 ? 1e6
                                       : 1e-5;
            if (below(10) == 0)
                angle = static_cast<std::int16_t>(angle + static_cast<int>(below(100)) - 30);
            if (below(300) == 0)
                source = static_cast<std::uint16_t>(below(65536));
        }
        x += static_cast<std::int32_t>(below(50));
        y += static_cast<std::int32_t>(below(5)) - 2;
        z += static_cast<std::int32_t>(below(30)) - 14;
        if (below(500) == 0)
            x = static_cast<std::int32_t>(below(0xFFFFFFFF)); // anywhere
        if (below(60) == 0)
            classification = static_cast<std::uint8_t>(below(256));
        if (below(90) == 0)
            userData = static_cast<std::uint8_t>(below(256));

        std::uint8_t* r = records.data() + i * length;
        storeLe(r, x);
        storeLe(r + 4, y);
        storeLe(r + 8, z);
        storeLe(r + 12, static_cast<std::uint16_t>(500 + below(200) * next));
        r[14] = static_cast<std::uint8_t>((next & 15) | returns << 4);
        const unsigned flags = below(30) == 0 ? below(256) : (i & 64) | 1;
        r[15] = static_cast<std::uint8_t>((flags & 0xCFu) | channel << 4);
        r[16] = classification;
        r[17] = userData;
        storeLe(r + 18, angle);
        storeLe(r + 20, source);
        storeLe(r + 22, times[line]);
        std::uint8_t* at = r + 30;
        if (of.pointFormat == 7 || of.pointFormat == 8 || of.pointFormat == 10) {
            const std::size_t parts = of.pointFormat == 7 ? 3 : 4;
            for (std::size_t c = 0; c < parts; ++c) {
                colour[c] = static_cast<std::uint16_t>(colour[c] + below(below(9) ? 9 : 3000));
                if (i % 1000 < 200)
                    colour[c] = colour[0]; // grey
                storeLe(at + 2 * c, colour[c]);
            }
            at += 2 * parts;
        }
        if (of.pointFormat >= 9) {
            waveOffset += below(9) == 0 ? waveSize / 2 + std::uint64_t{below(0xFFFFFFFF)}
                          : below(9)    ? waveSize
                                        : 0;
            if (below(200) == 0)
                waveOffset = std::uint64_t{below(0xFFFFFFFF)} << 20;
            if (below(5) == 0)
                waveSize = below(50) ? 100 + below(300) : 0x90000000u + below(100);
            at[0] = static_cast<std::uint8_t>(1 + below(2));
            storeLe(at + 1, waveOffset);
            storeLe(at + 9, waveSize);
            for (std::size_t c = 0; c < 4; ++c)
                storeLe(at + 13 + 4 * c, static_cast<float>(below(1000)) / 7);
            at += 29;
        }
        for (std::size_t b = 0; b < of.extraBytes; ++b) // every third constant
            at[b] = static_cast<std::uint8_t>(b % 3 == 2 ? 77 : x >> b);
        ++next;
    }
    return records;
}

Bytes encodeLayered(const LayeredCase& of, ByteSpan records, std::size_t piece) {
    auto encoder = makeLayeredEncoder(itemsOf(of));
    if (!encoder.ok())
        std::abort();
    const std::size_t length = recordLengthOf(itemsOf(of));
    (*encoder)->start();
    for (std::size_t at = 0; at < records.size(); at += piece * length)
        (*encoder)->encode(records.subspan(at, std::min(piece * length, records.size() - at)));
    ByteSpan chunk = (*encoder)->finish();
    return Bytes(chunk.begin(), chunk.end());
}

Result<Bytes> decodeLayered(const LayeredCase& of, ByteSpan chunk, std::size_t points, const Layers& wanted,
                            std::size_t piece) {
    const std::size_t length = recordLengthOf(itemsOf(of));
    auto padded = std::make_unique<std::uint8_t[]>(chunk.size() + decodePadding(length));
    std::fill_n(padded.get(), chunk.size() + decodePadding(length), std::uint8_t{0xA5});
    std::copy(chunk.begin(), chunk.end(), padded.get());
    STIPPLE_TRY(decoder, makeLayeredDecoder(itemsOf(of), wanted));
    STIPPLE_CHECK(decoder->start({padded.get(), chunk.size()}, points));
    Bytes records(points * length, 0xEE);
    for (std::size_t at = 0; at < records.size(); at += piece * length)
        STIPPLE_CHECK(decoder->decode({records.data() + at, std::min(piece * length, records.size() - at)}));
    return records;
}

} // namespace stipple::test
