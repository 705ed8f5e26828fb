#include "server/api/cloud_list_endpoint.hpp"

#include "server/http/problem.hpp"
#include "server/http/representation.hpp"
#include "server/http/target.hpp"
#include "server/site/cloud_json.hpp"
#include "shared/base/text.hpp"

#include <utility>

namespace stipple::server {

namespace {

struct ListPage {
    std::vector<std::string> ids;
    std::string next; // address; empty: this is the last page
};

ListPage pageOf(const ApiCall& call, std::size_t limit) {
    const std::string* after = call.query.find("after");
    ListPage page;
    page.ids = call.catalog.idsAfter(after != nullptr ? *after : "", limit + 1,
                                     [&](const std::string& id) { return call.visitor.mayRead(id); });
    if (page.ids.size() > limit) {
        page.ids.pop_back();
        page.next = cat("/api/v1/clouds?limit=", limit, "&after=", percentEncoded(page.ids.back()));
    }
    return page;
}

HttpResponse listResponse(const HttpRequest& request, const CloudList& list, bool seesAll,
                          std::int64_t nowSeconds) {
    auto representation = Representation::ofText(cloudListJson(list), "application/json", "no-cache");
    if (!seesAll)
        representation.vary = "Authorization";
    HttpResponse response = answerRepresentation(request, representation, nowSeconds);
    if (!list.next.empty())
        response.set("Link", cat("<", list.next, ">; rel=\"next\"")); // RFC 8288
    return response;
}

} // namespace

Answer answerClouds(const ApiCall& call) {
    auto limit = call.query.count("limit", 1, mostCloudsInList);
    if (!limit)
        return parameterProblem(limit.error());
    ListPage page = pageOf(call, static_cast<std::size_t>(limit->value_or(usualCloudsInList)));
    CloudList list;
    list.next = page.next;
    bool isKnown = true;
    for (const std::string& id : page.ids) {
        auto summary = call.catalog.knownSummary(id);
        isKnown = isKnown && summary.has_value();
        if (summary)
            list.clouds.emplace_back(id, *summary);
    }
    bool seesAll = call.visitor.seesAll();
    if (isKnown)
        return listResponse(call.request, list, seesAll, call.nowSeconds);

    auto work = [kept = std::make_shared<const KeptRequest>(call.request), page, seesAll,
                 now = call.nowSeconds, &catalog = call.catalog](AnswerWriter& writer) -> Status {
        CloudList made;
        made.next = page.next;
        for (const std::string& id : page.ids) {
            if (writer.isStopped())
                return Error{ErrorCode::cancelled, "the request was taken back", "", ""};
            if (auto summary = catalog.summary(id))
                made.clouds.emplace_back(id, *summary);
        }
        writer.answer(listResponse(kept->request(), made, seesAll, now));
        return {};
    };
    return Job{"clouds", std::move(work)};
}

} // namespace stipple::server
