// Files that leave byte by byte, as they do over HTTP.
#include "converter/export/format_sink.hpp"
#include "shared/base/text.hpp"
#include "shared/io/file_source.hpp"
#include "tests/unit/converter/export/export_fixture.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {

struct Streamed {
    FormatPlan plan;
    std::string body;
    WalkCounters counters;
};

Streamed streamed(const std::string& path, ExportFormat format, const PointFilter& wanted, int threads) {
    auto source = need(openFileSource(path));
    auto reader = need(CloudReader::open(*source));
    CloudFilter filter = need(CloudFilter::make(reader->metadata(), wanted));
    SinkInput input{reader->metadata(), {}};
    for (int a = 0; a < static_cast<int>(reader->metadata().schema.attributes.size()); ++a)
        input.attributes.push_back(a);
    WalkOptions options;
    options.threads = threads;
    Streamed made;
    bool finished = false;
    made.plan = need(planFormat(format, false, *reader, path, filter, input, options));
    FormatSink to =
        need(openFormatSink(made.plan, std::make_unique<LeavingSink>(made.body, finished), input));
    made.counters = need(walkPoints(*reader, path, filter, input.attributes, *to.sink, options));
    Status done = to.sink->finish();
    INFO((done.ok() ? "" : done.error().sentence()));
    REQUIRE(done.ok());
    REQUIRE(finished);
    return made;
}

} // namespace

TEST_CASE("what leaves byte by byte is what a file holds") {
    TemporaryFolder folder;
    std::string path = folder / "c.stipple";
    for (int pointFormat : {1, 7}) {
        TestScan scan = surfaceScan(pointFormat, 3000, 5);
        for (AttributeType type : {AttributeType::f32, AttributeType::u64}) // described extra bytes
            scan.schema.attributes.push_back({cat("Extra ", attributeTypeName(type)), type});
        scan.points.columns.resize(scan.schema.attributes.size());
        for (std::size_t a = scan.schema.attributes.size() - 2; a < scan.schema.attributes.size(); ++a)
            for (std::size_t i = 0; i < scan.points.size() * scan.schema.attributes[a].size(); ++i)
                scan.points.columns[a].push_back(static_cast<std::uint8_t>(i * 37 % 61));
        writeScan(scan, folder / "in.las");
        convertOrFail({folder / "in.las"}, path);
        BoxI bounds = allPoints(path).metadata.bounds;
        PointFilter part, coarse;
        part.gridBox = BoxI{bounds.min, Vec3i{(bounds.min.x + bounds.max.x) / 2, bounds.max.y, bounds.max.z}};
        coarse.spacing = 2;
        for (const PointFilter& filter : {PointFilter{}, part, coarse}) {
            for (auto [format, name] : {std::pair{ExportFormat::las, "out.las"},
                                        {ExportFormat::ply, "out.ply"},
                                        {ExportFormat::csv, "out.csv"}}) {
                ExportOptions options;
                options.filter = filter;
                ExportResult result = exportOrFail(path, folder / name, options);
                REQUIRE(result.points > 100);
                for (int threads : {1, 3}) {
                    Streamed stream = streamed(path, format, filter, threads);
                    INFO(name << ", point format " << pointFormat << ", " << threads << " threads");
                    CHECK(stream.counters.pointsTaken == result.points);
                    if (format != ExportFormat::csv)
                        CHECK(stream.plan.pointCount == result.points);
                    if (format == ExportFormat::ply) { // a file's count is written last, behind blanks
                        CHECK(readPly(stream.body).values == readPly(textOf(folder / name)).values);
                        continue;
                    }
                    CHECK((stream.body == textOf(folder / name)));
                }
            }
        }
    }
}

TEST_CASE("a LAS header of a whole cloud is known without reading a point") {
    TemporaryFolder folder;
    std::string path = folder / "c.stipple";
    TestScan scan = surfaceScan(7, 3000, 5);
    writeScan(scan, folder / "in.las");
    convertOrFail({folder / "in.las"}, path);
    exportOrFail(path, folder / "out.las");
    las::Header file = readLas(folder / "out.las").header;
    {
        // Every byte of every node but one would fail to decode.
        std::fstream damaged(path, std::ios::in | std::ios::out | std::ios::binary);
        AllPoints all = allPoints(path);
        damaged.seekp(static_cast<std::streamoff>(all.nodes.front().offsetBytes));
        damaged.write("\xFF\xFF\xFF\xFF", 4);
    }
    auto source = need(openFileSource(path));
    auto reader = need(CloudReader::open(*source));
    SinkInput input{reader->metadata(), {}};
    for (int a = 0; a < static_cast<int>(reader->metadata().schema.attributes.size()); ++a)
        input.attributes.push_back(a);
    CloudFilter everything = need(CloudFilter::make(reader->metadata(), {}));
    FormatPlan plan = need(planFormat(ExportFormat::las, false, *reader, path, everything, input, {}));
    REQUIRE(plan.lasSummary);
    CHECK(plan.lasSummary->pointCount == file.pointCount);
    CHECK(plan.lasSummary->pointsByReturn == file.pointsByReturn);
    CHECK(file.pointsByReturn[0] > 0);
    CHECK(reader->metadata().grid.toWorld(plan.lasSummary->bounds.min) == file.bounds.min);
    CHECK(reader->metadata().grid.toWorld(plan.lasSummary->bounds.max) == file.bounds.max);
}

TEST_CASE("LAZ needs bytes that can be written again") {
    SmallCloudFile file;
    auto source = need(openFileSource(file.path));
    auto reader = need(CloudReader::open(*source));
    CloudFilter everything = need(CloudFilter::make(reader->metadata(), {}));
    SinkInput input{reader->metadata(), {}};
    auto plan = planFormat(ExportFormat::laz, false, *reader, file.path, everything, input, {});
    REQUIRE_FALSE(plan.ok());
    CHECK(plan.error().code == ErrorCode::invalidArgument);
    CHECK(planFormat(ExportFormat::laz, true, *reader, file.path, everything, input, {}).ok());
}
