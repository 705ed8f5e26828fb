#include "converter/synth/synthesize.hpp"

#include "converter/synth/ordered_blocks.hpp"
#include "converter/synth/scan_block.hpp"
#include "shared/base/text.hpp"
#include "shared/las/las_reader.hpp"
#include "shared/las/las_writer.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::synth {

namespace {

constexpr std::uint64_t pulsesPerBlock = 8192;
constexpr double spareShare = 0.006; // more pulses than the estimate asks for; the rest is cut

struct Plan {
    std::vector<Source> sources;
    std::vector<std::uint64_t> quota;      // points of each source
    std::vector<std::uint64_t> firstBlock; // of each source, and one past the last
};

// Points over the sources by weight; rounding goes to the first.
std::vector<std::uint64_t> shares(const std::vector<Source>& sources, std::uint64_t points) {
    std::vector<std::uint64_t> quota;
    std::uint64_t given = 0;
    for (const Source& source : sources) {
        quota.push_back(
            static_cast<std::uint64_t>(static_cast<double>(points) * source.weight * (1 - 1e-12)));
        given += quota.back();
    }
    quota[0] += points - given;
    return quota;
}

// Returns a pulse, estimated from pulses all over the pattern.
double returnsPerPulse(const Scanner& scanner, const Source& source, std::uint64_t quota) {
    Source sample = source;
    double wanted = std::clamp(static_cast<double>(quota) / 16, 256.0, 8192.0);
    planPulses(sample, wanted);
    std::uint64_t returns = 0;
    for (std::uint64_t i = 0; i < sample.pulses(); ++i)
        returns += scanner.countReturns(sample, i);
    return static_cast<double>(returns) / static_cast<double>(sample.pulses());
}

Plan planScan(const Scene& scene, const Scanner& scanner, const SynthOptions& options) {
    Plan plan;
    std::vector<double> yield;
    for (Source& source : planSources(scene)) {
        double perPulse = returnsPerPulse(scanner, source, options.points / 16);
        // A place from which next to nothing is seen is no place to scan from.
        if (perPulse < 0.02)
            continue;
        plan.sources.push_back(source);
        yield.push_back(perPulse);
    }
    double sum = 0;
    for (const Source& source : plan.sources)
        sum += source.weight;
    for (Source& source : plan.sources)
        source.weight /= sum;
    if (plan.sources.empty())
        return plan;
    plan.quota = shares(plan.sources, options.points);
    std::uint64_t blocks = 0;
    for (std::size_t i = 0; i < plan.sources.size(); ++i) {
        planPulses(plan.sources[i], static_cast<double>(plan.quota[i]) / yield[i] * (1 + spareShare));
        plan.firstBlock.push_back(blocks);
        if (plan.quota[i] > 0)
            blocks += (plan.sources[i].pulses() + pulsesPerBlock - 1) / pulsesPerBlock;
    }
    plan.firstBlock.push_back(blocks);
    return plan;
}

// Takes blocks in order, cuts each source at its quota and refills it where its pattern was not enough.
class Collector {
  public:
    using Scan = std::function<PointBatch(std::size_t source, std::uint64_t block)>;
    Collector(const Plan& plan, const SynthOptions& options, const Schema& schema, Scan scan,
              const PointSink& sink, const ProgressSink& progress)
        : plan_(plan), options_(options), schema_(schema), columns_(schema), scan_(std::move(scan)),
          sink_(sink), progress_(progress) {}

    Status take(std::size_t source, std::uint64_t block, PointBatch batch) {
        std::uint64_t blocksPlanned = plan_.firstBlock[source + 1] - plan_.firstBlock[source];
        STIPPLE_CHECK(add(source, std::move(batch)));
        if (block + 1 < blocksPlanned)
            return {};
        std::uint64_t empty = 0;
        for (std::uint64_t extra = block + 1; taken_ < plan_.quota[source]; ++extra) {
            std::uint64_t before = taken_;
            STIPPLE_CHECK(add(source, scan_(source, extra)));
            empty = taken_ == before ? empty + 1 : 0;
            if (empty > 1000)
                return Error{ErrorCode::limitExceeded,
                             cat("source ", plan_.sources[source].pointSourceId, " sees nothing to measure"),
                             "", "use another seed"};
        }
        taken_ = 0;
        return {};
    }

    SynthReport report;

  private:
    Status add(std::size_t source, PointBatch batch) {
        std::uint64_t left = plan_.quota[source] - taken_;
        if (left == 0)
            return {};
        cutBatch(batch, static_cast<std::size_t>(std::min<std::uint64_t>(left, batch.size())), schema_,
                 columns_);
        taken_ += batch.size();
        report.points += batch.size();
        STIPPLE_CHECK(sink_(batch));
        if (progress_)
            progress_(report.points, options_.points);
        return {};
    }

    const Plan& plan_;
    const SynthOptions& options_;
    const Schema& schema_;
    ScanColumns columns_;
    Scan scan_;
    const PointSink& sink_;
    const ProgressSink& progress_;
    std::uint64_t taken_ = 0; // of the present source
};

} // namespace

double sideFor(SceneKind kind, std::uint64_t points) {
    double growth = std::cbrt(static_cast<double>(points) / 5e6);
    double side = kind == SceneKind::town ? std::clamp(400 * growth, 300.0, 1600.0)
                                          : std::clamp(700 * growth, 400.0, 4000.0);
    return kind == SceneKind::indoor ? 0 : 20 * std::round(side / 20);
}

Grid gridOf(const Scene& scene) {
    return {{0.001, 0.001, 0.001}, scene.origin()};
}

const std::string& crsWkt() {
    static const std::string wkt =
        R"(PROJCS["WGS 84 / UTM zone 32N",GEOGCS["WGS 84",DATUM["WGS_1984",)"
        R"(SPHEROID["WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],)"
        R"(PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],)"
        R"(UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4326"]],)"
        R"(PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],)"
        R"(PARAMETER["central_meridian",9],PARAMETER["scale_factor",0.9996],)"
        R"(PARAMETER["false_easting",500000],PARAMETER["false_northing",0],)"
        R"(UNIT["metre",1,AUTHORITY["EPSG","9001"]],AXIS["Easting",EAST],AXIS["Northing",NORTH],)"
        R"(AUTHORITY["EPSG","32632"]])";
    return wkt;
}

Schema scanSchema(bool normals) {
    Schema schema = las::schemaOf(7);
    if (normals)
        for (const char* name : {"NormalX", "NormalY", "NormalZ"})
            schema.attributes.push_back({name, AttributeType::f32});
    return schema;
}

Result<SynthReport> scanScene(const Scene& scene, const SynthOptions& options, const PointSink& sink,
                              const ProgressSink& progress) {
    Scanner scanner(scene, options.seed, options.noiseMeters);
    Plan plan = planScan(scene, scanner, options);
    if (plan.sources.empty())
        return Error{ErrorCode::limitExceeded, "no strip or station sees the scene", "", "use another seed"};
    Schema schema = scanSchema(options.normals);
    ScanColumns columns(schema);
    Grid grid = gridOf(scene);
    auto scan = [&](std::size_t source, std::uint64_t block) {
        return scanPulses(scanner, plan.sources[source], options.seed, block * pulsesPerBlock, pulsesPerBlock,
                          schema, columns, grid, scene.origin());
    };
    auto sourceOf = [&](std::uint64_t block) {
        auto after = std::upper_bound(plan.firstBlock.begin(), plan.firstBlock.end(), block);
        return static_cast<std::size_t>(after - plan.firstBlock.begin()) - 1;
    };
    Collector collector(plan, options, schema, scan, sink, progress);
    Status status;
    runInOrder(
        plan.firstBlock.back(), std::max(1u, options.threads),
        [&](std::uint64_t block) {
            std::size_t source = sourceOf(block);
            return scan(source, block - plan.firstBlock[source]);
        },
        [&](std::uint64_t block, PointBatch batch) {
            std::size_t source = sourceOf(block);
            status = collector.take(source, block - plan.firstBlock[source], std::move(batch));
            return status.ok();
        });
    STIPPLE_CHECK(status);
    SynthReport& report = collector.report;
    for (const Source& source : plan.sources)
        ++(source.kind == Source::Kind::strip ? report.strips : report.stations);
    report.sideMeters = scene.sideMeters();
    report.sceneObjects = scene.objectCount();
    report.scenePrimitives = scene.primitiveCount();
    return report;
}

Result<SynthReport> synthesize(const std::string& path, const SynthOptions& options,
                               const ProgressSink& progress) {
    auto scene = Scene::make(options.scene, options.seed, sideFor(options.scene, options.points));
    las::WriterOptions writing;
    writing.grid = gridOf(*scene);
    writing.schema = scanSchema(options.normals);
    writing.pointFormat = 7;
    writing.versionMinor = 4;
    writing.wkt = crsWkt();
    writing.systemIdentifier = "stipple synth";
    writing.globalEncoding = 1; // adjusted standard GPS time
    STIPPLE_TRY(writer, las::Writer::create(path, writing));
    STIPPLE_TRY(report, scanScene(
                            *scene, options, [&](const PointBatch& batch) { return writer->write(batch); },
                            progress));
    STIPPLE_CHECK(writer->finish());
    return report;
}

} // namespace stipple::synth
