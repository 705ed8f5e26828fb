// The program of a decoding worker: decodeNode, called from www/src/wasm/decoder_worker.ts. It keeps the
// metadata of each cloud and the latest answer, whose arrays the worker copies out before the next call.
#include "client/web/cloud_message.hpp"
#include "client/web/decode_messages.hpp"

#include <emscripten/emscripten.h>

#include <map>

using namespace stipple;

namespace {

using SharedMetadata = std::shared_ptr<const CloudMetadata>;
std::map<std::uint32_t, Result<SharedMetadata>> clouds;
Bytes answerMessage;
ResidentNode answerNode;

Result<ResidentNode> decode(ByteSpan message, ByteSpan first, ByteSpan second) {
    STIPPLE_TRY(job, web::decodeJob(message));
    auto cloud = clouds.find(job.cloud);
    if (cloud == clouds.end())
        return Error{ErrorCode::cancelled, say("the cloud was closed"), "decoding worker", ""};
    STIPPLE_TRY(metadata, cloud->second);
    job.metadata = metadata;
    (job.strata > 0 ? job.picture : job.shown).assign(first.begin(), first.end());
    job.attributes.assign(second.begin(), second.end());
    return decodeNode(job);
}

} // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE void stipple_describe_cloud(std::uint32_t cloud, const std::uint8_t* at,
                                                 std::size_t size) {
    Result<CloudMetadata> parsed = web::decodeCloud({at, size});
    clouds.insert_or_assign(
        cloud, parsed.ok() ? Result<SharedMetadata>(std::make_shared<const CloudMetadata>(std::move(*parsed)))
                           : Result<SharedMetadata>(parsed.error()));
}

EMSCRIPTEN_KEEPALIVE void stipple_forget_cloud(std::uint32_t cloud) {
    clouds.erase(cloud);
}

// Decodes the job of `message`, whose bytes come beside it (decode_messages.hpp); returns the size of the
// answer's message (client/web/decode_messages.hpp).
EMSCRIPTEN_KEEPALIVE std::size_t stipple_decode(const std::uint8_t* message, std::size_t messageSize,
                                                const std::uint8_t* first, std::size_t firstSize,
                                                const std::uint8_t* second, std::size_t secondSize) {
    Result<ResidentNode> node = decode({message, messageSize}, {first, firstSize}, {second, secondSize});
    answerMessage = web::encodeAnswer(node);
    answerNode = node.ok() ? std::move(*node) : ResidentNode{};
    return answerMessage.size();
}

EMSCRIPTEN_KEEPALIVE const std::uint8_t* stipple_answer_message() {
    return answerMessage.data();
}
EMSCRIPTEN_KEEPALIVE const std::uint8_t* stipple_answer_array(int index) {
    return web::nodeArray(answerNode, index).data();
}
EMSCRIPTEN_KEEPALIVE std::size_t stipple_answer_array_size(int index) {
    return web::nodeArray(answerNode, index).size();
}

} // extern "C"
