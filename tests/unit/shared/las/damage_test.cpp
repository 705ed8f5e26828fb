// Damaged files: an error or the points that are there, never a crash, and memory in proportion to the file.
#include "tests/support/byte_values.hpp"
#include "tests/unit/shared/las/allocation_meter.hpp"
#include "tests/unit/shared/las/las_bytes.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {

// A small file with everything in it: records, extra bytes, extended records, a signature.
Bytes sample(int versionMinor) {
    int format = versionMinor >= 4 ? 7 : versionMinor == 3 ? 5 : 1;
    LasRecipe recipe{versionMinor, format, 4};
    recipe.extraBytes = 9;
    las::Vlr extra{"LASF_Spec", 4, "Extra Bytes", Bytes(2 * 192), false};
    extra.data[2] = 6; // int32
    extra.data[3] = 0x1F;
    extra.data[4] = 'a';
    extra.data[192 + 2] = 23; // uint16 × 3: more than the record has left
    extra.data[192 + 4] = 'b';
    recipe.vlrs = {extra, {"someone", 1, "", Bytes(20, 0x55), false}};
    if (versionMinor >= 4)
        recipe.vlrs.push_back({"else", 2, "", Bytes(20, 0x66), true});
    if (versionMinor == 0)
        recipe.beforePoints = {0xDD, 0xCC};
    return lasBytes(recipe);
}

// Reads the file, and checks that the answer is possible and was cheap.
void requireSane(const Bytes& bytes) {
    MemorySource source(bytes);
    std::size_t before = allocatedBytes();
    auto reader = las::Reader::open(source);
    if (reader.ok()) {
        const las::Header& header = (*reader)->header();
        PointBatch points;
        Status read = (*reader)->read(0, (*reader)->pointCount(), points);
        REQUIRE(read.ok() == !header.compressed);
        if (read.ok()) {
            REQUIRE(points.size() == (*reader)->pointCount());
            if (points.size() > 0)
                REQUIRE(header.pointDataOffset + points.size() * header.recordLength <= bytes.size());
            REQUIRE(points.columns.size() == (*reader)->schema().attributes.size());
        }
    } else {
        REQUIRE(!reader.error().what.empty());
        REQUIRE(!reader.error().where.empty());
    }
    // A claimed record length of up to 64 KiB makes up to 257 undescribed attributes, whatever the file has.
    REQUIRE(allocatedBytes() - before < 256 * 1024 + 64 * bytes.size());
}

std::vector<std::uint64_t> extremes(std::uint64_t fileBytes) {
    constexpr std::uint64_t infinity = 0x7FF0000000000000, nan = 0x7FF8000000000000;
    return {0, ~0ull, ~0ull >> 1, 1ull << 63, fileBytes, fileBytes - 1, infinity, nan};
}

} // namespace

TEST_CASE("a file cut after any byte gives an error or the points before the cut") {
    for (int minor = 0; minor <= 4; ++minor) {
        Bytes whole = sample(minor);
        LasContents all = requireLas(whole);
        for (std::size_t length = 0; length < whole.size(); ++length) {
            CAPTURE(minor, length);
            Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
            requireSane(cut);
            auto contents = readLas(cut);
            if (length <= all.header.pointDataOffset) {
                REQUIRE(!contents.ok());
                continue;
            }
            REQUIRE(contents.ok());
            std::size_t held =
                std::min<std::size_t>(4, (length - all.header.pointDataOffset) / all.header.recordLength);
            REQUIRE(contents->points.size() == held);
            REQUIRE(!contents->warnings.empty());
            for (std::size_t i = 0; i < held; ++i)
                REQUIRE(contents->points.positions[i] == all.points.positions[i]);
        }
    }
}

TEST_CASE("any value in any byte before the points gives an error or a possible answer") {
    for (int minor = 0; minor <= 4; ++minor) {
        Bytes bytes = sample(minor);
        std::size_t front = requireLas(bytes).header.pointDataOffset;
        for (std::size_t at = 0; at < front; ++at) {
            std::uint8_t original = bytes[at];
            const bool isHeader = at < 375;
            for (std::uint8_t value : isHeader ? everyDamage(original) : likelyDamage(original)) {
                bytes[at] = value;
                requireSane(bytes);
            }
            bytes[at] = original;
        }
    }
}

TEST_CASE("extreme values in any field of any width give an error or a possible answer") {
    for (int minor = 0; minor <= 4; ++minor) {
        Bytes bytes = sample(minor);
        std::size_t front = requireLas(bytes).header.pointDataOffset;
        for (std::size_t at = 0; at < front; ++at)
            for (std::size_t width : {2u, 4u, 8u})
                for (std::uint64_t value : extremes(bytes.size())) {
                    Bytes broken = bytes;
                    std::memcpy(broken.data() + at, &value, std::min(width, broken.size() - at));
                    requireSane(broken);
                }
    }
}

TEST_CASE("thousands of random changes give errors or possible answers") {
    std::mt19937 random(7);
    for (int round = 0; round < 20000; ++round) {
        Bytes bytes = sample(static_cast<int>(random() % 5));
        for (unsigned changes = 1 + random() % 8; changes > 0; --changes)
            bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
        if (random() % 4 == 0)
            bytes.resize(random() % bytes.size());
        requireSane(bytes);
    }
}

TEST_CASE("a file that fails while it is read says so") {
    // Answers from the `failAt`-th read on with an error.
    class FailingSource final : public ByteSource {
      public:
        FailingSource(Bytes bytes, int failAt) : inner_(std::move(bytes)), left_(failAt) {}
        RequestId read(ByteRange range, Completion done) override {
            if (left_-- > 0)
                return inner_.read(range, std::move(done));
            done(Error{ErrorCode::networkFailed, "the connection broke", "", ""});
            return 0;
        }
        std::uint64_t sizeBytes() const override { return inner_.sizeBytes(); }
        std::string name() const override { return "failing"; }

      private:
        MemorySource inner_;
        int left_;
    };
    Bytes bytes = sample(4);
    int reads = 0;
    for (;; ++reads) {
        FailingSource source(bytes, reads);
        auto contents = readLas(source);
        if (contents.ok())
            break;
        CHECK(contents.error().code == ErrorCode::networkFailed);
        REQUIRE(reads < 20);
    }
    CHECK(reads >= 2);
}
