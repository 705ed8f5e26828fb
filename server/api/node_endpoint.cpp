#include "server/api/node_endpoint.hpp"

#include "server/api/node_points.hpp"
#include "server/http/problem.hpp"
#include "shared/base/text.hpp"

namespace stipple::server {

namespace {

// A request made up, ready to be answered by any thread once the node's entry is known.
struct NodeAnswer {
    std::string id;
    std::shared_ptr<const CloudVersion> cloud;
    NodeKey key;
    NodePart part;
    const Format* format;
    Validity validity;

    HttpResponse head() const {
        HttpResponse response;
        response.set("Content-Type", contentTypeOf(*format));
        if (exportFormatOf(*format))
            response.set("Content-Disposition", contentDisposition(cat(id, "-", key.text()), *format));
        validity.setFields(response);
        return response;
    }
};

bool isStored(const NodeAnswer& answer) {
    return answer.format->name == storedFormat.name;
}

// Sent from the file, no byte of it read here.
HttpResponse storedFromFile(const NodeAnswer& answer, const NodeEntry& entry) {
    HttpResponse response = answer.head();
    for (const ByteRange& range : storedRanges(answer.cloud->metadata, entry, answer.part))
        response.body.push_back(FileSlice{answer.cloud->file, range.offset, range.size});
    return response;
}

Status storedFromSource(const NodeAnswer& answer, const NodeEntry& entry, ByteSource& source,
                        AnswerWriter& writer) {
    HttpResponse response = answer.head();
    for (const ByteRange& range : storedRanges(answer.cloud->metadata, entry, answer.part)) {
        STIPPLE_TRY(bytes, readNow(source, range));
        response.body.push_back(std::string(bytes.begin(), bytes.end()));
    }
    writer.answer(std::move(response));
    return {};
}

Status decoded(const NodeAnswer& answer, const NodeEntry& entry, ByteSource& source, AnswerWriter& writer) {
    StopGate gate(&writer.isStopped());
    STIPPLE_TRY(text, nodeFile({*answer.format, answer.id}, *answer.cloud, entry, answer.part, source, gate));
    HttpResponse response = answer.head();
    response.body.push_back(std::move(text));
    writer.answer(std::move(response));
    return {};
}

Status answerEntry(const NodeAnswer& answer, const NodeEntry& entry, ByteSource& source,
                   AnswerWriter& writer) {
    if (answer.validity.conditional)
        writer.answer(*answer.validity.conditional);
    else if (!isStored(answer))
        return decoded(answer, entry, source, writer);
    else if (answer.cloud->file)
        writer.answer(storedFromFile(answer, entry));
    else
        return storedFromSource(answer, entry, source, writer);
    return {};
}

} // namespace

Answer answerNode(const ApiCall& call) {
    auto key = nodeKeyOf(call);
    if (!key)
        return parameterProblem(key.error());
    auto part = nodePartOf(call);
    if (!part)
        return parameterProblem(part.error());
    const std::string* formatName = call.query.find(nodeFormatParameter.name);
    auto chosen = chooseFormat(call.request, formatName ? *formatName : "", nodeFormats);
    if (auto* refusal = std::get_if<HttpResponse>(&chosen))
        return *refusal;
    auto [format, variesByAccept] = std::get<ChosenFormat>(chosen);

    std::string variant = cat("node ", key->text(), " ", format->name, " ", part->text());
    NodeAnswer answer{call.id,          call.cloud, *key,
                      std::move(*part), format,     validityOf(call, variant, variesByAccept)};
    HierarchyCache& hierarchy = call.resources.hierarchy;
    HierarchyCache::Known known = hierarchy.lookUp(*call.cloud, *key);
    if (std::holds_alternative<HierarchyCache::Absent>(known))
        return problemResponse({problem_types::noSuchNode, cat("the cloud has no node ", key->text())});
    if (auto* entry = std::get_if<NodeEntry>(&known)) {
        if (answer.validity.conditional)
            return *answer.validity.conditional;
        if (isStored(answer) && call.cloud->file)
            return storedFromFile(answer, *entry);
    }
    return Job{"node", [answer = std::move(answer), &hierarchy](AnswerWriter& writer) -> Status {
                   auto source = answer.cloud->openSource();
                   STIPPLE_TRY(entry, hierarchy.find(*answer.cloud, *source, answer.key, writer.isStopped()));
                   return answerEntry(answer, entry, *source, writer);
               }};
}

} // namespace stipple::server
