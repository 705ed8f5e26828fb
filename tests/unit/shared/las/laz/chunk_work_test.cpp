// LAZ files whose chunks somebody else compresses.
#include "tests/unit/shared/las/laz/laz_bytes.hpp"

#include <deque>

using namespace stipple;
using namespace stipple::test;

namespace {

// Compresses a chunk when it is taken; fails from chunk number `failsAt` on.
class LateWork final : public las::ChunkWork {
  public:
    LateWork(std::size_t most, std::size_t failsAt, std::size_t& longest)
        : most_(most), failsAt_(failsAt), longest_(longest) {}

    void submit(std::function<Bytes()> compress) override {
        waiting_.push_back(std::move(compress));
        longest_ = std::max(longest_, waiting_.size());
    }
    std::size_t waiting() const override { return waiting_.size(); }
    std::size_t mostWaiting() const override { return most_; }
    Result<Bytes> take() override {
        if (taken_++ >= failsAt_)
            return Error{ErrorCode::outOfMemory, "no memory for a chunk", "", ""};
        Bytes bytes = waiting_.front()();
        waiting_.pop_front();
        return bytes;
    }

  private:
    std::size_t most_, failsAt_, taken_ = 0;
    std::size_t& longest_;
    std::deque<std::function<Bytes()>> waiting_;
};

struct Written {
    Status status;
    std::size_t longest = 0; // most chunks that waited
};

Written writeWith(const std::string& path, las::WriterOptions options, const PointBatch& points,
                  std::size_t most, std::size_t failsAt = 1000) {
    Written written;
    options.makeChunkWork = [&]() -> std::unique_ptr<las::ChunkWork> {
        return std::make_unique<LateWork>(most, failsAt, written.longest);
    };
    auto writer = las::Writer::create(path, options);
    REQUIRE(writer.ok());
    written.status = (*writer)->write(points);
    if (written.status)
        written.status = (*writer)->finish();
    return written;
}

} // namespace

TEST_CASE("chunks that are compressed elsewhere are the file's, in order, and few wait", "[laz]") {
    TemporaryFolder folder;
    for (int format : {1, 6})
        for (std::size_t points : {0u, 1u, 50000u, 210000u}) {
            CAPTURE(format, points);
            LasRecipe recipe{4, format, points};
            LasContents las = requireLas(lasBytes(recipe, smoothRecords(format, 0, points)));
            las::WriterOptions options;
            options.grid = las.header.grid;
            options.schema = las.schema;
            options.pointFormat = format;
            options.compressed = true;
            auto writer = las::Writer::create(folder.file("here.laz"), options);
            REQUIRE(writer.ok());
            REQUIRE((*writer)->write(las.points).ok());
            REQUIRE((*writer)->finish().ok());
            const Bytes here = fileBytes(folder.file("here.laz"));
            for (std::size_t most : {1u, 3u}) {
                Written written = writeWith(folder.file("there.laz"), options, las.points, most);
                REQUIRE(written.status.ok());
                CHECK(written.longest == std::min<std::size_t>(most, (points + 49999) / 50000));
                CHECK((fileBytes(folder.file("there.laz")) == here));
            }
        }
}

TEST_CASE("a chunk that can't be compressed ends the file, and leaves none", "[laz]") {
    TemporaryFolder folder;
    LasRecipe recipe{2, 0, 210000};
    LasContents las = requireLas(lasBytes(recipe, smoothRecords(0, 0, recipe.points)));
    las::WriterOptions options;
    options.grid = las.header.grid;
    options.schema = las.schema;
    options.pointFormat = 0;
    options.compressed = true;
    for (std::size_t failsAt : {0u, 2u, 4u}) {
        Written written = writeWith(folder.file("out.laz"), options, las.points, 3, failsAt);
        REQUIRE_FALSE(written.status.ok());
        CHECK(written.status.error().code == ErrorCode::outOfMemory);
        std::FILE* file = std::fopen(folder.file("out.laz").c_str(), "rb");
        CHECK(file == nullptr);
    }
}
