#include "server/api/statistics_endpoint.hpp"

#include "converter/export/walk_points.hpp"
#include "server/api/points_request.hpp"
#include "server/api/statistics_document.hpp"
#include "server/api/statistics_parameters.hpp"
#include "server/http/problem.hpp"
#include "shared/base/text.hpp"

#include <nlohmann/json.hpp>

namespace stipple::server {

namespace {

// A request made up, ready to be answered by any thread.
struct StatisticsJob {
    std::string id;
    std::shared_ptr<const CloudVersion> cloud;
    CloudFilter filter; // over cloud->metadata
    std::vector<int> attributes;
    std::size_t bins;
    PointLimits limits;
    Validity validity;
    std::string key; // by which the answer is kept

    const CloudMetadata& metadata() const { return cloud->metadata; }
};

const AttributeStatistics& storedOf(const StatisticsJob& job, int attribute) {
    return job.metadata().statistics[static_cast<std::size_t>(attribute)];
}

const Attribute& attributeOf(const StatisticsJob& job, int attribute) {
    return job.metadata().schema.attributes[static_cast<std::size_t>(attribute)];
}

// Stored statistics are of all values, also of those that mean "no value"; where each value is counted,
// these can be left out.
bool isToldByFile(const StatisticsJob& job) {
    bool isKnown = job.filter.wantsEverything() && job.bins == 0;
    for (int attribute : job.attributes)
        isKnown =
            isKnown && (!attributeOf(job, attribute).noData || !storedOf(job, attribute).histogram.empty());
    return isKnown;
}

PartialStatistics ofValues(const Attribute& attribute,
                           const std::vector<std::pair<std::int64_t, std::uint64_t>>& values) {
    PartialStatistics all;
    all.histogram.emplace();
    for (const auto& [value, points] : values) {
        auto number = static_cast<double>(value);
        if (attribute.noData && number == *attribute.noData)
            continue;
        PartialStatistics one{points, number, number, number, 0, {}};
        one.histogram.emplace();
        one.histogram->emplace(value, points);
        all.merge(one);
    }
    return all;
}

PartialStatistics ofStored(const StatisticsJob& job, int index) {
    const Attribute& attribute = attributeOf(job, index);
    const AttributeStatistics& stored = storedOf(job, index);
    PartialStatistics told{job.metadata().pointCount * static_cast<std::uint64_t>(attribute.components),
                           stored.min,
                           stored.max,
                           stored.mean,
                           0,
                           {}};
    told.squares = stored.deviation * stored.deviation * static_cast<double>(told.count);
    if (stored.histogram.empty())
        return told;
    PartialStatistics counted = ofValues(attribute, stored.histogram);
    if (attribute.noData)
        return counted;
    told.histogram = std::move(counted.histogram);
    return told;
}

StatisticsAnswer emptyAnswer(const StatisticsJob& job) {
    StatisticsAnswer answer;
    answer.id = job.id;
    answer.version = job.cloud->version();
    return answer;
}

Result<StatisticsAnswer> toldByFile(const StatisticsJob& job, CloudReader& reader, const WalkOptions& walk) {
    StatisticsAnswer answer = emptyAnswer(job);
    const CloudMetadata& metadata = job.metadata();
    answer.pointCount = metadata.pointCount;
    answer.columns = statisticsColumns({metadata, job.attributes}, metadata.bounds, 0);
    for (int axis = 0; axis < 3; ++axis)
        answer.statistics.push_back({{metadata.pointCount,
                                      static_cast<double>(metadata.bounds.min[axis]),
                                      static_cast<double>(metadata.bounds.max[axis]),
                                      0,
                                      0,
                                      {}},
                                     {}});
    for (int attribute : job.attributes)
        answer.statistics.push_back({ofStored(job, attribute), {}});
    auto visited = reader.visitWanted([&](const NodeEntry& entry) -> Result<bool> {
        STIPPLE_CHECK(askGate(walk.gate, 0));
        LevelCount& level = answer.levels[static_cast<std::size_t>(entry.key.level)];
        level.nodes += entry.pointCount > 0;
        level.points += entry.pointCount;
        return true;
    });
    if (!visited)
        return visited.error();
    return answer;
}

Result<StatisticsAnswer> computed(const StatisticsJob& job, CloudReader& reader, const WalkOptions& walk) {
    STIPPLE_TRY(tally, tallyNodes(reader, job.filter, walk));
    if (tally.points > job.limits.maxPoints)
        return Error{ErrorCode::limitExceeded,
                     cat(tally.points, " points would have to be read, and at most ", job.limits.maxPoints,
                         " are for one request; ask for less: a smaller region, a spacing"),
                     "", ""};
    SinkInput input{job.metadata(), job.attributes};
    StatisticsSink sink(statisticsColumns(input, job.filter.reach(), job.bins));
    STIPPLE_TRY(counters, walkPoints(reader, "the cloud", job.filter, job.attributes, sink, walk));
    StatisticsAnswer answer = emptyAnswer(job);
    answer.isComputed = true;
    answer.pointCount = counters.pointsTaken;
    for (std::size_t level = 0; level < answer.levels.size(); ++level)
        answer.levels[level] = {counters.levels[level].nodes, counters.levels[level].points};
    answer.columns = sink.columns();
    answer.statistics = sink.statistics();
    return answer;
}

Result<std::string> documentOf(const StatisticsJob& job, const WorkGate& gate) {
    auto source = job.cloud->openSource();
    auto reader = CloudReader::over(*source, job.cloud->header, job.metadata());
    WalkOptions walk;
    walk.threads = job.limits.threads;
    walk.gate = &gate;
    auto answer = isToldByFile(job) ? toldByFile(job, *reader, walk) : computed(job, *reader, walk);
    if (!answer)
        return answer.error();
    nlohmann::ordered_json json = statisticsJson(*answer, job.metadata());
    return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

HttpResponse responseOf(const StatisticsJob& job, const std::string& document) {
    HttpResponse response;
    response.set("Content-Type", std::string(jsonFormat.mediaType));
    job.validity.setFields(response);
    response.body.push_back(document);
    return response;
}

// Made once, however many ask for it at a time, and kept.
Status answerJob(const StatisticsJob& job, ApiResources& resources, AnswerWriter& writer) {
    using Made = SharedCache<std::string, std::string>::Made;
    StopGate gate(&writer.isStopped());
    auto make = [&]() -> Result<Made> {
        STIPPLE_TRY(document, documentOf(job, gate));
        std::uint64_t bytes = document.size() + job.key.size();
        return Made{std::make_shared<const std::string>(std::move(document)), bytes};
    };
    STIPPLE_TRY(document, resources.statistics.get(job.key, make, writer.isStopped()));
    writer.answer(responseOf(job, *document));
    return {};
}

Result<StatisticsJob> jobOf(const ApiCall& call) {
    STIPPLE_TRY(request, pointsRequestOf(call));
    STIPPLE_TRY(bins, countOf(call.query, binsParameter));
    auto filter = CloudFilter::make(call.cloud->metadata, request.filter);
    if (!filter)
        return parameterError("", filter.error().what, filter.error().advice);
    std::string variant = cat("statistics\n", canonicalQuery(call.query, statisticsParameters));
    return StatisticsJob{call.id,
                         call.cloud,
                         *std::move(filter),
                         std::move(request.attributes),
                         static_cast<std::size_t>(bins.value_or(0)),
                         call.resources.limits.points,
                         validityOf(call, variant),
                         keptKeyOf(call, // the id is part of the answer
                                   cat(call.id, "\n", variant))};
}

} // namespace

Answer answerStatistics(const ApiCall& call) {
    auto job = jobOf(call);
    if (!job)
        return requestProblem(job.error());
    if (job->validity.conditional)
        return *std::move(job->validity.conditional);
    ApiResources& resources = call.resources;
    if (auto document = resources.statistics.find(job->key))
        return responseOf(*job, *document);
    auto owned = std::make_shared<const StatisticsJob>(*std::move(job));
    return Job{"statistics",
               [owned, &resources](AnswerWriter& writer) { return answerJob(*owned, resources, writer); }};
}

} // namespace stipple::server
