#include "server/api/batch_endpoint.hpp"

#include "server/api/points_request.hpp"
#include "server/http/problem.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <optional>

namespace stipple::server {

namespace {

struct WantedNode {
    NodeKey key;
    int strata = strataCount;
};

// A request made up, ready to be answered by any thread.
struct Batch {
    std::shared_ptr<const CloudVersion> cloud;
    std::vector<WantedNode> nodes;
    std::vector<int> attributes;
    Validity validity;
};

using Entries = std::vector<std::optional<NodeEntry>>; // parallel to Batch::nodes; nothing: no such node

Result<WantedNode> wantedNode(std::string_view text, int strata) {
    std::size_t colon = std::min(text.find(':'), text.size());
    auto key = nodeKeyFromText(text.substr(0, colon));
    std::string_view own = text.substr(colon);
    bool isStrata = own.size() == 2 && own[1] >= '1' && own[1] <= '0' + strataCount;
    if (!key || !(own.empty() || isStrata))
        return parameterError(keysParameter.name, cat(quotedValue(text), " is no key of a node"),
                              "write level-x-y-z, or level-x-y-z:strata, joined by commas");
    return WantedNode{*key, own.empty() ? strata : own[1] - '0'};
}

Result<std::vector<WantedNode>> wantedNodes(const ApiCall& call, int strata) {
    const std::string* keys = call.query.find(keysParameter.name);
    if (!keys)
        return missingParameter(keysParameter);
    std::vector<WantedNode> nodes;
    for (std::string_view text : splitAt(*keys, ',')) {
        if (nodes.size() == maxBatchKeys)
            return parameterError(keysParameter.name, cat("it has more than ", maxBatchKeys, " keys"),
                                  "ask several times");
        STIPPLE_TRY(node, wantedNode(text, strata));
        nodes.push_back(node);
    }
    return nodes;
}

std::vector<ByteRange> rangesOf(const Batch& batch, std::size_t i, const NodeEntry& entry) {
    return storedRanges(batch.cloud->metadata, entry, {batch.nodes[i].strata, batch.attributes});
}

std::uint64_t sizeOf(const std::vector<ByteRange>& ranges) {
    std::uint64_t bytes = 0;
    for (const ByteRange& range : ranges)
        bytes += range.size;
    return bytes;
}

std::string frameHead(const WantedNode& node, bool exists, std::uint64_t bytes) {
    ByteWriter writer;
    for (std::uint32_t number : {exists ? 200u : 404u, std::uint32_t{node.key.level}, node.key.x, node.key.y,
                                 node.key.z, static_cast<std::uint32_t>(node.strata)})
        writer.write(number);
    writer.write(bytes);
    return std::string(writer.bytes().begin(), writer.bytes().end());
}

Status checkSize(const Batch& batch, const Entries& entries) {
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < entries.size(); ++i)
        if (entries[i])
            bytes += sizeOf(rangesOf(batch, i, *entries[i]));
    if (bytes > maxBatchBytes)
        return Error{ErrorCode::limitExceeded,
                     cat("these nodes have ", bytes, " bytes, and an answer at most ", maxBatchBytes), "",
                     ""};
    return {};
}

// `source` null: sent from the file, no byte of it read here.
Result<HttpResponse> framed(const Batch& batch, const Entries& entries, ByteSource* source) {
    STIPPLE_CHECK(checkSize(batch, entries));
    HttpResponse response;
    response.set("Content-Type", std::string(batchFormat.mediaType));
    batch.validity.setFields(response);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        std::vector<ByteRange> ranges;
        if (entries[i])
            ranges = rangesOf(batch, i, *entries[i]);
        response.body.push_back(frameHead(batch.nodes[i], entries[i].has_value(), sizeOf(ranges)));
        for (const ByteRange& range : ranges) {
            if (!source) {
                response.body.push_back(FileSlice{batch.cloud->file, range.offset, range.size});
                continue;
            }
            STIPPLE_TRY(bytes, readNow(*source, range));
            response.body.push_back(std::string(bytes.begin(), bytes.end()));
        }
    }
    return response;
}

// Nothing if a chunk of the hierarchy would have to be read.
std::optional<Entries> knownEntries(const Batch& batch, HierarchyCache& hierarchy) {
    Entries entries;
    for (const WantedNode& node : batch.nodes) {
        HierarchyCache::Known known = hierarchy.lookUp(*batch.cloud, node.key);
        if (std::holds_alternative<HierarchyCache::Unknown>(known))
            return std::nullopt;
        auto* entry = std::get_if<NodeEntry>(&known);
        entries.push_back(entry ? std::optional(*entry) : std::nullopt);
    }
    return entries;
}

Result<Entries> readEntries(const Batch& batch, HierarchyCache& hierarchy, ByteSource& source,
                            const std::atomic<bool>& stop) {
    Entries entries;
    for (const WantedNode& node : batch.nodes) {
        auto entry = hierarchy.find(*batch.cloud, source, node.key, stop);
        if (!entry && entry.error().code != ErrorCode::notFound)
            return entry.error();
        entries.push_back(entry ? std::optional(*entry) : std::nullopt);
    }
    return entries;
}

Result<Batch> batchOf(const ApiCall& call) {
    STIPPLE_TRY(part, nodePartOf(call));
    STIPPLE_TRY(nodes, wantedNodes(call, part.strata));
    std::string variant = "batch";
    for (const WantedNode& node : nodes)
        variant += cat(" ", node.key.text(), ":", node.strata);
    variant += cat(" / ", part.text());
    return Batch{call.cloud, std::move(nodes), std::move(part.attributes), validityOf(call, variant)};
}

} // namespace

Answer answerBatch(const ApiCall& call) {
    auto batch = batchOf(call);
    if (!batch)
        return requestProblem(batch.error());
    if (batch->validity.conditional)
        return *batch->validity.conditional;
    HierarchyCache& hierarchy = call.resources.hierarchy;
    if (call.cloud->file)
        if (auto entries = knownEntries(*batch, hierarchy)) {
            auto response = framed(*batch, *entries, nullptr);
            return response ? *response : jobProblem(response.error());
        }
    return Job{"batch", [batch = std::move(*batch), &hierarchy](AnswerWriter& writer) -> Status {
                   auto source = batch.cloud->openSource();
                   STIPPLE_TRY(entries, readEntries(batch, hierarchy, *source, writer.isStopped()));
                   STIPPLE_TRY(response, framed(batch, entries, batch.cloud->file ? nullptr : source.get()));
                   writer.answer(std::move(response));
                   return {};
               }};
}

} // namespace stipple::server
