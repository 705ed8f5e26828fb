// The item WAVEPACKET13, version 1: the 29 bytes of formats 4 and 5 that point into waveform data.
//
//   0 descriptor u8   1 offset u64   9 size u32   13 return point f32   17 dx, dy, dz f32
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/las/laz/coding.hpp"

namespace stipple::las::laz {

class WavePacket13V1 {
  public:
    static constexpr std::size_t size = 29;
    static constexpr std::size_t maxBytes = 64;

    void start(const std::uint8_t* first) {
        last_ = Packet::load(first + 1);
        lastStep_ = 0;
        lastStepKind_ = same;
        descriptor_.init();
        for (auto& model : stepKind_)
            model.init();
        step_.init();
        packetSize_.init();
        returnPoint_.init();
        direction_.init();
    }

    template <class Coder, class Byte>
    Coder code(Coder coder, Byte* record) {
        Packet packet = last_;
        unsigned descriptor = 0;
        if constexpr (encodes<Coder>) {
            packet = Packet::load(record + 1);
            descriptor = record[0];
        }
        descriptor = codeSymbol(coder, descriptor_, descriptor);
        codeOffset(coder, packet);
        packet.size = codeInteger(coder, packetSize_, last_.size, packet.size);
        packet.returnPoint = codeInteger(coder, returnPoint_, last_.returnPoint, packet.returnPoint);
        for (unsigned axis = 0; axis < 3; ++axis)
            packet.direction[axis] =
                codeInteger(coder, direction_, last_.direction[axis], packet.direction[axis], axis);
        last_ = packet;
        if constexpr (!encodes<Coder>) {
            record[0] = static_cast<std::uint8_t>(descriptor);
            packet.store(record + 1);
        }
        return coder;
    }

  private:
    // Floats as the integers of their bits.
    struct Packet {
        std::uint64_t offset = 0;
        std::int32_t size = 0, returnPoint = 0;
        std::array<std::int32_t, 3> direction{};

        static Packet load(const std::uint8_t* from) {
            return {loadLe<std::uint64_t>(from),
                    loadLe<std::int32_t>(from + 8),
                    loadLe<std::int32_t>(from + 12),
                    {loadLe<std::int32_t>(from + 16), loadLe<std::int32_t>(from + 20),
                     loadLe<std::int32_t>(from + 24)}};
        }
        void store(std::uint8_t* to) const {
            storeLe(to, offset);
            storeLe(to + 8, size);
            storeLe(to + 12, returnPoint);
            for (std::size_t axis = 0; axis < 3; ++axis)
                storeLe(to + 16 + 4 * axis, direction[axis]);
        }
    };

    // How the offset follows from the last: packets lie one behind the other in a usual file.
    enum StepKind : unsigned { same, behind, near, far };

    template <class Coder>
    STIPPLE_LAZ_INLINE void codeOffset(Coder& coder, Packet& packet) {
        const auto wide = static_cast<std::int64_t>(packet.offset - last_.offset);
        const auto step = static_cast<std::int32_t>(wide);
        // A size above 2^31 looks negative here, but is added as the unsigned number it is.
        const bool follows = step > 0 && step == last_.size;
        unsigned kind = wide != step ? far : step == 0 ? same : follows ? behind : near;
        kind = codeSymbol(coder, stepKind_[lastStepKind_], kind);
        lastStepKind_ = kind;
        if (kind == behind) {
            packet.offset = last_.offset + static_cast<std::uint32_t>(last_.size);
        } else if (kind == near) {
            lastStep_ = codeInteger(coder, step_, lastStep_, step);
            packet.offset = last_.offset + static_cast<std::uint64_t>(static_cast<std::int64_t>(lastStep_));
        } else if (kind == far) {
            if constexpr (encodes<Coder>)
                coder.writeInt64(packet.offset);
            else
                packet.offset = coder.readInt64();
        } else {
            packet.offset = last_.offset;
        }
    }

    Packet last_;
    std::int32_t lastStep_ = 0;
    unsigned lastStepKind_ = same;
    SymbolModel<256> descriptor_;
    std::array<SymbolModel<4>, 4> stepKind_;
    IntegerCompressor<32> step_, packetSize_, returnPoint_;
    IntegerCompressor<32, 3> direction_;
};

} // namespace stipple::las::laz
