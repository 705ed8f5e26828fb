// Work on large nodes that nobody wants any more: how many points are handled after it was stopped.
#include "converter/export/format_sink.hpp"
#include "converter/export/nearest_points.hpp"
#include "shared/io/byte_sink.hpp"
#include "shared/io/memory_source.hpp"
#include "tests/support/counting_gate.hpp"
#include "tests/unit/converter/export/export_fixture.hpp"

#include <limits>

using namespace stipple;
using namespace stipple::test;

namespace {

constexpr std::uint32_t pointsOfNode = 5 * WorkGate::pieceItems + 123;

// Two levels of large nodes; the upper one shows mean colours and has the exact ones in a block of their own.
struct LargeNodes {
    SmallCloud cloud = makeSmallCloud({.levels = 2,
                                       .pointsPerNode = pointsOfNode,
                                       .rootCube = {{0, 0, 0}, 20},
                                       .innerColour = InnerColour::mean});
    MemorySource source{cloud.file};
    std::unique_ptr<CloudReader> reader = need(CloudReader::open(source));
    std::vector<int> attributes = everyAttribute();

    std::vector<int> everyAttribute() const {
        std::vector<int> all;
        for (std::size_t a = 0; a < cloud.metadata.schema.attributes.size(); ++a)
            all.push_back(static_cast<int>(a));
        return all;
    }
};

// Runs `work(gate)` with gates that close at `steps` places of it. What is let through are pieces, and once
// it is closed nothing goes on: whatever was begun (`begun` things at most, and who waits for them) asks once
// more and ends. Of one thread's work, what is done between two questions is a small part of the whole.
template <class Work>
std::uint64_t checkStops(int steps, int begun, bool isOneThread, const Work& work) {
    CountingGate open;
    double before = CountingGate::cpuSeconds();
    Status whole = work(open);
    double seconds = CountingGate::cpuSeconds() - before;
    REQUIRE(whole.ok());
    CHECK(open.largest() <= WorkGate::pieceItems);
    if (isOneThread)
        CHECK(open.longestSeconds() < 0.3 * seconds); // a piece is a fifth of a node
    for (int step = 0; step < steps; ++step) {
        CountingGate gate(open.handled() * static_cast<std::uint64_t>(step) /
                          static_cast<std::uint64_t>(steps));
        Status stopped = work(gate);
        REQUIRE_FALSE(stopped.ok());
        CHECK(stopped.error().code == ErrorCode::cancelled);
        CHECK(gate.refused() >= 1);
        CHECK(gate.refused() <= begun + 1);
    }
    return open.handled();
}

} // namespace

TEST_CASE_METHOD(LargeNodes, "decoding a large node ends within a piece of its points") {
    const NodeEntry& root = cloud.nodes.front();
    REQUIRE(root.attributeBytes.front() > 0); // exact colours
    NodeBytes bytes = need(reader->fetchNode(root, attributes));
    PointBatch whole = need(decodeNode(cloud.metadata, bytes));
    std::uint64_t handled = checkStops(40, 1, true, [&](const WorkGate& gate) -> Status {
        auto points = decodeNode(cloud.metadata, bytes, &gate);
        if (!points)
            return points.error();
        requireEqual(*points, whole);
        return {};
    });
    // Keys, their order, places and coordinates of each point; of each attribute planes, values and places.
    CHECK(handled >= (4 + 3 * attributes.size()) * std::uint64_t{pointsOfNode});
}

TEST_CASE_METHOD(LargeNodes, "an export of large nodes ends with the pieces in work") {
    std::string body;
    bool finished = false;
    const auto nodes = static_cast<int>(cloud.nodes.size());
    PointFilter some;
    some.region = std::make_shared<PolygonRegion>(std::vector<Polygon>{
        {Ring({{100, 100}, {900000, 1000}, {800000, 900000}, {2000, 700000}, {100, 100}}), {}}});
    some.conditions = {{"Intensity", {{100, 60000}}}};
    for (const PointFilter& wanted : {PointFilter{}, some}) {
        CloudFilter filter = need(CloudFilter::make(cloud.metadata, wanted));
        SinkInput input{cloud.metadata, attributes};
        for (ExportFormat format : {ExportFormat::las, ExportFormat::csv, ExportFormat::laz})
            for (int threads : {1, 3}) {
                INFO(exportFormatName(format) << ", " << threads);
                std::uint64_t handled =
                    checkStops(7, nodes, threads == 1, [&](const WorkGate& gate) -> Status {
                        body.clear();
                        WalkOptions options;
                        options.threads = threads;
                        options.gate = &gate;
                        Bytes memory;
                        bool inMemory = needsOverwriting(format);
                        STIPPLE_TRY(plan, planFormat(format, inMemory, *reader, "c", filter, input, options));
                        std::unique_ptr<ByteSink> to = std::make_unique<LeavingSink>(body, finished);
                        if (inMemory)
                            to = std::make_unique<MemorySink>(memory);
                        STIPPLE_TRY(sink, openFormatSink(plan, std::move(to), input));
                        auto walked = walkPoints(*reader, "c", filter, attributes, *sink.sink, options);
                        return walked ? Status() : Status(walked.error());
                    });
                CHECK(handled > 10 * cloud.metadata.pointCount);
            }
    }
}

TEST_CASE_METHOD(LargeNodes, "thinning, profiles and searches in large nodes end within a piece, too") {
    PointFilter spaced, along;
    spaced.spacing = 40;
    along.corridor =
        std::make_shared<Corridor>(need(Corridor::make({{1000, 1000}, {900000, 800000}}, 200000)));
    CloudMetadata metadata = cloud.metadata;
    metadata.spacing = 5000; // of the upper node
    CloudFilter thinned = need(CloudFilter::make(metadata, spaced));
    CloudFilter inCorridor = need(CloudFilter::make(cloud.metadata, along));
    for (const CloudFilter* filter : {&thinned, &inCorridor}) {
        PointBatch points = need(reader->readNode(cloud.nodes.back()));
        std::vector<const Bytes*> none;
        std::uint64_t handled = checkStops(20, 1, true, [&](const WorkGate& gate) -> Status {
            CloudFilter::Dropped dropped;
            STIPPLE_TRY(rows, filter->select(cloud.nodes.back(), points.positions, none, dropped, &gate));
            CHECK_FALSE(rows.empty());
            if (!filter->hasCorridor())
                return {};
            auto places = filter->placesAlong(cloud.nodes.back(), points.positions, &gate);
            return places ? Status() : Status(places.error());
        });
        CHECK(handled >= std::uint64_t{pointsOfNode} * (filter->hasCorridor() ? 2 : 1));
    }
    CloudFilter everything = need(CloudFilter::make(cloud.metadata, {}));
    DistanceRank rank({500000, 500000, 0}, false, std::numeric_limits<double>::infinity());
    std::uint64_t handled = checkStops(20, 1, true, [&](const WorkGate& gate) -> Status {
        auto found = nearestPoints(*reader, "c", everything, rank, 5, &gate);
        return found ? Status() : Status(found.error());
    });
    CHECK(handled >= 5 * std::uint64_t{pointsOfNode}); // decoded and ranked
}
