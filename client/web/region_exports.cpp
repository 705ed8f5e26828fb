// The program of the region worker (www/src/regions/region_worker.ts): client/region/region_work.hpp, one
// work at a time. Texts go in as UTF-8 and come back in a buffer that stands until the next call.
#include "client/region/region_work.hpp"
#include "client/web/region_messages.hpp"

#include "client/core/json.hpp"

#include <emscripten/emscripten.h>

using namespace stipple;

namespace {

std::unique_ptr<RegionWork> work;
std::string text;
Bytes piece;

const char* give(std::string value) {
    text = std::move(value);
    return text.c_str();
}
const char* giveError(const Error& error) {
    return give(jsonText({{"error", error.said()}}));
}

Result<nlohmann::json> open(ByteSpan metadata, const char* request) {
    STIPPLE_TRY(parsed, parseMetadata(metadata));
    STIPPLE_TRY(wanted, parseJson(request, "region"));
    STIPPLE_TRY(made, RegionWork::make(std::make_shared<const CloudMetadata>(std::move(parsed)), wanted));
    work = std::move(made);
    return work->scan();
}

Status take(ByteSpan message, ByteSpan bytes) {
    STIPPLE_TRY(node, web::decodeRegionNode(message));
    node.node.bytes.assign(bytes.begin(), bytes.end());
    return work->take(std::move(node.node), node.tested);
}

} // namespace

extern "C" {

// Begins another work. {"answer": {"region": {…}, "attributes": […]}}, what the scan is to be asked for, or
// {"error": sentence}. `metadata`: as in the file.
EMSCRIPTEN_KEEPALIVE const char* stipple_region_open(const std::uint8_t* metadata, std::size_t size,
                                                     const char* request) {
    work.reset();
    Result<nlohmann::json> scan = open({metadata, size}, request);
    return scan.ok() ? give(jsonText({{"answer", *scan}})) : giveError(scan.error());
}

// {} or {"error": sentence}. The bytes that were made of the node are then to be taken.
EMSCRIPTEN_KEEPALIVE const char* stipple_region_node(const std::uint8_t* message, std::size_t messageSize,
                                                     const std::uint8_t* bytes, std::size_t size) {
    Status taken = take({message, messageSize}, {bytes, size});
    return taken.ok() ? give("{}") : giveError(taken.error());
}

// {"answer": {…}} or {"error": sentence}; then the last bytes and the patches are to be taken.
EMSCRIPTEN_KEEPALIVE const char* stipple_region_finish() {
    Result<nlohmann::json> answer = work->finish();
    return answer.ok() ? give(jsonText({{"answer", *answer}})) : giveError(answer.error());
}
EMSCRIPTEN_KEEPALIVE double stipple_region_points() {
    return static_cast<double>(work->points());
}

// Bytes of the file that is made, each once; they stand until the next call. The size of what there is:
EMSCRIPTEN_KEEPALIVE std::size_t stipple_region_piece() {
    piece = work->pieces().take();
    return piece.size();
}
// The next bytes that are to be written over; -1: none are left, else where.
EMSCRIPTEN_KEEPALIVE double stipple_region_patch() {
    auto& patches = work->pieces().patches;
    if (patches.empty())
        return -1;
    auto offset = static_cast<double>(patches.front().first);
    piece = std::move(patches.front().second);
    patches.erase(patches.begin());
    return offset;
}
EMSCRIPTEN_KEEPALIVE const std::uint8_t* stipple_region_bytes() {
    return piece.data();
}
EMSCRIPTEN_KEEPALIVE std::size_t stipple_region_bytes_size() {
    return piece.size();
}
EMSCRIPTEN_KEEPALIVE void stipple_region_close() {
    work.reset();
    piece = {};
}

} // extern "C"
