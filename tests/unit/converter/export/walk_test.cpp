// The core without files: what a server does.
#include "converter/export/ply_sink.hpp"
#include "shared/io/memory_source.hpp"
#include "shared/sinks/csv_sink.hpp"
#include "tests/unit/converter/export/export_fixture.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {

struct OpenCloud {
    SmallCloud cloud = makeSmallCloud();
    MemorySource source{cloud.file};
    std::unique_ptr<CloudReader> reader = need(CloudReader::open(source));
    std::string body;
    bool finished = false;

    std::unique_ptr<ByteSink> sink() { return std::make_unique<LeavingSink>(body, finished); }
};

} // namespace

TEST_CASE_METHOD(OpenCloud, "a PLY stream begins with the number of its points, counted before") {
    PointFilter wanted;
    wanted.gridBox = BoxI{{0, 0, 0}, {70000, 50000, 131071}};
    CloudFilter filter = need(CloudFilter::make(reader->metadata(), wanted));
    std::uint64_t count = need(countPoints(*reader, "memory", filter, {}));
    SinkInput input{reader->metadata(), {0}};
    CHECK_FALSE(plySink(sink(), input, std::nullopt).ok());
    auto ply = need(plySink(sink(), input, count));
    WalkOptions options;
    options.threads = 2;
    WalkCounters counters = need(walkPoints(*reader, "memory", filter, input.attributes, *ply, options));
    CHECK(counters.pointsTaken == count);
    CHECK(counters.whole.nodes > 0);
    CHECK(counters.tested.nodes > 0);
    CHECK_FALSE(finished);
    REQUIRE(ply->finish().ok());
    CHECK(finished);
    CHECK(readPly(body).count == count);
}

TEST_CASE_METHOD(OpenCloud, "a PLY whose points are not as many as it says is not finished") {
    CloudFilter filter = need(CloudFilter::make(reader->metadata(), {}));
    SinkInput input{reader->metadata(), {}};
    auto ply = need(plySink(sink(), input, cloud.metadata.pointCount + 1));
    need(walkPoints(*reader, "memory", filter, {}, *ply, {}));
    CHECK_FALSE(ply->finish().ok());
    CHECK_FALSE(finished);
}

TEST_CASE_METHOD(OpenCloud, "counting reads no node that is wholly wanted") {
    PointFilter wanted;
    wanted.gridBox = BoxI{{-10, -10, -10}, {1 << 20, 1 << 20, 1 << 20}};
    CloudFilter filter = need(CloudFilter::make(reader->metadata(), wanted));
    for (const NodeEntry& node : cloud.nodes) // so that reading one would fail
        cloud.file[node.offsetBytes] ^= 1;
    MemorySource damaged(cloud.file);
    auto again = need(CloudReader::open(damaged));
    CHECK(need(countPoints(*again, "memory", filter, {})) == cloud.metadata.pointCount);
}

TEST_CASE_METHOD(OpenCloud, "an error of the sink ends the walk") {
    class FullSink final : public ByteSink {
      public:
        Status finish() override { return {}; }

      private:
        Status put(ByteSpan bytes) override {
            room_ -= static_cast<std::ptrdiff_t>(bytes.size());
            return room_ >= 0 ? Status() : Status(Error{ErrorCode::writeFailed, "the disk is full", "", ""});
        }
        std::ptrdiff_t room_ = 50000;
    };
    CloudFilter filter = need(CloudFilter::make(reader->metadata(), {}));
    SinkInput input{reader->metadata(), {0, 1}};
    for (int threads : {1, 3}) {
        auto csv = need(csvSink(std::make_unique<FullSink>(), input));
        WalkOptions options;
        options.threads = threads;
        auto walked = walkPoints(*reader, "memory", filter, input.attributes, *csv, options);
        REQUIRE_FALSE(walked.ok());
        CHECK(walked.error().code == ErrorCode::writeFailed);
    }
}
