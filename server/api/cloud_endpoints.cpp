#include "server/api/cloud_endpoints.hpp"

#include "server/http/problem.hpp"
#include "server/http/representation.hpp"
#include "server/site/cloud_json.hpp"

#include <nlohmann/json.hpp>

namespace stipple::server {

namespace {

constexpr const char* jsonType = "application/json";
constexpr const char* revalidated = "no-cache";

Answer answerJson(const ApiCall& call, std::string text) {
    return answerRepresentation(call.request, Representation::ofText(std::move(text), jsonType, revalidated),
                                call.nowSeconds);
}

} // namespace

Answer answerCloud(const ApiCall& call) {
    return answerJson(call, cloudJson(call.id, *call.cloud));
}

Answer answerProblemType(const ApiCall& call) {
    for (const ProblemType& type : problemTypes())
        if (call.names.front() == type.name) {
            nlohmann::ordered_json json{{"type", problemAddress(type)},
                                        {"title", type.title},
                                        {"status", type.status},
                                        {"meaning", type.meaning}};
            return answerJson(call, json.dump() + "\n");
        }
    return problemResponse(404, "there is no problem of this name");
}

} // namespace stipple::server
