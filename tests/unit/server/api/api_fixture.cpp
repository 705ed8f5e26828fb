#include "tests/unit/server/api/api_fixture.hpp"

#include "server/http/problem.hpp"

namespace stipple::test {

namespace {

using namespace server;
constexpr std::int64_t now = 1'700'000'000;

void append(std::string& text, const HttpResponse& response) {
    for (const BodyPart& part : response.body) {
        if (const auto* slice = std::get_if<FileSlice>(&part)) {
            std::string bytes(static_cast<std::size_t>(slice->size), '\0');
            REQUIRE(slice->file->readAt(slice->offset, bytes.data(), bytes.size()));
            text += bytes;
        } else {
            text += std::get<std::string>(part);
        }
    }
}

class Collector final : public AnswerWriter {
  public:
    void answer(HttpResponse response) override {
        REQUIRE_FALSE(hasBegun);
        hasBegun = true;
        head = std::move(response);
        append(body, head);
    }
    Status begin(HttpResponse response) override {
        REQUIRE_FALSE(hasBegun);
        REQUIRE(response.body.empty());
        hasBegun = true;
        head = std::move(response);
        return {};
    }
    Status write(ByteSpan bytes) override {
        REQUIRE(hasBegun);
        body.append(bytes.begin(), bytes.end());
        return {};
    }
    const std::atomic<bool>& isStopped() const override { return stopped; }
    void handOver(Job) override { FAIL("no endpoint hands its work over"); }

    bool hasBegun = false;
    std::atomic<bool> stopped{false};
    HttpResponse head;
    std::string body;
};

} // namespace

ApiFixture::ApiFixture(const SmallCloudOptions& options, const ApiLimits& limits)
    : cloud_(makeSmallCloud(options)), resources_(limits) {
    writeText(path(), std::string(cloud_.file.begin(), cloud_.file.end()));
    auto opened = CloudCatalog::open({path()});
    REQUIRE(opened.ok());
    catalog_ = std::move(opened->catalog);
}

ApiFixture::ApiFixture(const std::string& path, const ApiLimits& limits) : resources_(limits) {
    auto opened = CloudCatalog::open({path});
    REQUIRE(opened.ok());
    catalog_ = std::move(opened->catalog);
}

ApiAnswer ApiFixture::ask(const std::string& target, Fields fields, std::string_view method) const {
    HttpRequest request{method, target, 11, std::move(fields)};
    auto parsed = parseTarget(request.target);
    REQUIRE(parsed.ok());
    Visitor visitor(nullptr, request, parsed->query, now);
    Answer answer = answerApi(request, *parsed, {*catalog_, resources_, visitor}, now);
    ApiAnswer result;
    if (auto* job = std::get_if<Job>(&answer)) {
        Collector collector;
        Status status = job->run(collector);
        if (!status && !collector.hasBegun)
            collector.answer(jobProblem(status.error()));
        result.response = collector.head;
        result.body = collector.body;
    } else {
        result.response = std::get<HttpResponse>(answer);
        append(result.body, result.response);
    }
    result.status = result.response.status;
    if (result.field("Content-Type").find("json") != std::string::npos)
        result.json = nlohmann::json::parse(result.body, nullptr, false);
    return result;
}

} // namespace stipple::test
