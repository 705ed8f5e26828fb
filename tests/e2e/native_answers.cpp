// What the native program measures of the points that somebody picked on the page.
//
//   native_answers CLOUD < REQUESTS
//
// A request a line: those of client/survey/measure_json.hpp, and {"make": "volume", …} of
// client/region/region_work.hpp, whose points are read from CLOUD. An answer a line, {"error": "…"} for a
// request that can't be answered. Exit status 1: CLOUD can't be read.
#include "client/region/region_work.hpp"
#include "client/survey/measure_json.hpp"
#include "shared/io/file_source.hpp"
#include "shared/select/region_json.hpp"

#include <iostream>
#include <string>

using namespace stipple;
using nlohmann::json;

namespace {

Result<json> volumeOf(CloudReader& reader, const json& request) {
    auto metadata = std::make_shared<const CloudMetadata>(reader.metadata());
    STIPPLE_TRY(work, RegionWork::make(metadata, request));
    STIPPLE_TRY(region, regionFromJson(work->scan()["region"], "region"));
    STIPPLE_TRY(filter, CloudFilter::make(*metadata, region));
    STIPPLE_CHECK(reader.visitNodes([&](const NodeEntry& entry) -> Status {
        CloudFilter::Verdict verdict = filter.verdictOn(entry);
        bool isTested = verdict == CloudFilter::Verdict::tested;
        if (!isTested && verdict != CloudFilter::Verdict::whole)
            return {};
        STIPPLE_TRY(node, reader.fetchNode(entry, work->attributesToRead(isTested)));
        return work->take(std::move(node), isTested);
    }));
    return work->finish();
}

json answerTo(CloudReader& reader, const std::string& line) {
    json request = json::parse(line, nullptr, false);
    bool isVolume = request.is_object() && request.contains("make");
    Result<json> answer = isVolume ? volumeOf(reader, request) : survey::measureJson(request);
    return answer.ok() ? *answer : json{{"error", answer.error().sentence()}};
}

Status answerAll(const std::string& cloud) {
    STIPPLE_TRY(source, openFileSource(cloud));
    STIPPLE_TRY(reader, CloudReader::open(*source));
    for (std::string line; std::getline(std::cin, line);)
        std::cout << answerTo(*reader, line).dump() << '\n';
    return {};
}

} // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::cerr << "native_answers CLOUD < REQUESTS\n";
        return 2;
    }
    Status answered = answerAll(arguments[1]);
    if (!answered.ok())
        std::cerr << answered.error().sentence() << '\n';
    return answered.ok() ? 0 : 1;
}
