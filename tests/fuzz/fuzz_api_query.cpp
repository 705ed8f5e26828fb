// The query of a request, put to every endpoint, and the key of a node. What the parsers take has to mean
// something: filters can be made of it, and answer questions without contradicting themselves.
#include "server/api/api.hpp"
#include "server/api/points_request.hpp"
#include "shared/select/cloud_filter.hpp"

#include <cstdlib>
#include <filesystem>

using namespace stipple;
using namespace stipple::server;

namespace {

void require(bool holds) {
    if (!holds)
        std::abort();
}

const CloudVersion& cloud() {
    static const CloudVersion version = [] {
        CloudVersion made;
        CloudMetadata& metadata = made.metadata;
        metadata.grid = {{0.01, 0.01, 0.01}, {500000, 4000000, 0}};
        metadata.rootCube = {{0, 0, 0}, 17};
        metadata.bounds = {{0, 0, 0}, {100000, 90000, 5000}};
        metadata.pointCount = 1000;
        metadata.spacing = 1;
        Attribute scaled{"Height", AttributeType::i16};
        scaled.scale = 0.1;
        scaled.noData = -1;
        metadata.schema.attributes = {{"Intensity", AttributeType::u16},
                                      {"Classification", AttributeType::u8},
                                      {"GPS Time", AttributeType::f64},
                                      scaled};
        metadata.statistics.resize(metadata.schema.attributes.size());
        metadata.statistics[1].histogram = {{2, 500}, {6, 500}};
        made.validators.etag = "\"v\"";
        return made;
    }();
    return version;
}

// Verdicts on nodes have to agree with those on points.
void checkFilter(const PointFilter& wanted) {
    auto made = CloudFilter::make(cloud().metadata, wanted);
    require(made.ok()); // what is no filter was refused as a parameter
    const CloudFilter& filter = *made;
    NodeEntry root;
    root.pointCount = 3;
    auto verdict = filter.verdictOn(root);
    const BoxI& bounds = cloud().metadata.bounds;
    std::vector<Vec3i> positions{bounds.min, bounds.max, {50000, 45000, 2500}};
    std::vector<Bytes> columns;
    std::vector<const Bytes*> tested;
    for (int a : filter.testedAttributes())
        columns.push_back(Bytes(3 * cloud().metadata.schema.attributes[static_cast<std::size_t>(a)].size()));
    for (const Bytes& column : columns)
        tested.push_back(&column);
    CloudFilter::Dropped dropped;
    auto selected = filter.select(root, positions, tested, dropped);
    require(selected.ok());
    const std::vector<std::uint32_t>& rows = *selected;
    require(rows.size() + dropped.bySpacing + dropped.byRegion + dropped.byAttribute == positions.size());
    if (verdict == CloudFilter::Verdict::outside)
        require(rows.empty());
    if (verdict == CloudFilter::Verdict::whole)
        require(rows.size() == positions.size());
    if (filter.hasCorridor())
        require(filter.placesAlong(root, positions).ok());
}

void checkAnswer(const Answer& answer) {
    if (const auto* response = std::get_if<HttpResponse>(&answer))
        require(response->status == 200 || response->status == 304 || response->status == 400 ||
                response->status == 404 || response->status == 406 || response->status == 410 ||
                response->status == 412);
}

void checkKey(std::string_view text) {
    auto key = nodeKeyFromText(text);
    require(!key || (key->text() == text && key->level <= maxLevel));
}

// Of no clouds.
const CloudCatalog& catalog() {
    static const std::unique_ptr<CloudCatalog> none = [] {
        std::string folder = (std::filesystem::temp_directory_path() / "stipple-fuzz-XXXXXX").string();
        require(mkdtemp(folder.data()) != nullptr);
        auto opened = CloudCatalog::open({folder});
        std::filesystem::remove(folder);
        require(opened.ok());
        return std::move(opened->catalog);
    }();
    return *none;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 8192)
        return 0;
    std::string_view text(reinterpret_cast<const char*>(data), size);
    checkKey(text);
    auto query = Query::parse(text);
    if (!query) {
        require(query.error().code == ErrorCode::invalidArgument);
        return 0;
    }
    static const std::shared_ptr<const CloudVersion> version(&cloud(), [](const CloudVersion*) {});
    static ApiResources resources;
    HttpRequest request{"GET", "/", 11, {}};
    Visitor visitor(nullptr, request, "", 0);
    ApiCall call{request,       *query,  {"fuzz", "0-0-0-0"}, "fuzz",   version,
                 1'700'000'000, visitor, catalog(),           resources};
    auto points = pointsRequestOf(call);
    if (points)
        checkFilter(points->filter);
    else
        require(!points.error().what.empty());
    for (const Endpoint& endpoint : endpoints())
        checkAnswer(endpoint.answer(call));
    return 0;
}
