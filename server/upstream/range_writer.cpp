#include "server/upstream/range_writer.hpp"

#include <algorithm>
#include <vector>

namespace stipple::server {

namespace {

const FileSlice* sliceElsewhere(const BodyPart& part) {
    const auto* slice = std::get_if<FileSlice>(&part);
    return slice != nullptr && slice->file == nullptr ? slice : nullptr;
}

// Of the block, what lies in the range.
ByteSpan overlap(const Bytes& block, std::uint64_t index, ByteRange range) {
    std::uint64_t begin = index * BlockCache::blockBytes;
    std::uint64_t from = std::max(begin, range.offset), to = std::min(begin + block.size(), range.end());
    return ByteSpan(block).subspan(static_cast<std::size_t>(from - begin),
                                   static_cast<std::size_t>(to - from));
}

using TakeBytes = std::function<Status(ByteSpan bytes)>;

Status readRange(ByteRange range, UpstreamVersion& version, const std::atomic<bool>& stop,
                 const TakeBytes& take) {
    auto run = BlockCache::blocksOf(range);
    for (std::uint64_t at = 0; at < run.count; at += UpstreamVersion::runBlocks) {
        BlockCache::Run step{run.first + at, std::min(UpstreamVersion::runBlocks, run.count - at)};
        STIPPLE_TRY(blocks, version.blocks(step, stop));
        for (std::uint64_t i = 0; i < step.count; ++i)
            STIPPLE_CHECK(take(overlap(*blocks[static_cast<std::size_t>(i)], step.first + i, range)));
    }
    return {};
}

Status readParts(const HttpResponse& response, UpstreamVersion& version, const std::atomic<bool>& stop,
                 const TakeBytes& take) {
    for (const BodyPart& part : response.body) {
        if (const auto* slice = sliceElsewhere(part)) {
            STIPPLE_CHECK(readRange({slice->offset, slice->size}, version, stop, take));
        } else {
            const auto& text = std::get<std::string>(part);
            STIPPLE_CHECK(take(ByteSpan(reinterpret_cast<const std::uint8_t*>(text.data()), text.size())));
        }
    }
    return {};
}

void appendTo(std::string& text, ByteSpan bytes) {
    text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

} // namespace

bool needsBytes(const HttpResponse& response) {
    return response.sendsBody &&
           std::any_of(response.body.begin(), response.body.end(),
                       [](const BodyPart& part) { return sliceElsewhere(part) != nullptr; });
}

bool fillFromHeld(HttpResponse& response, UpstreamVersion& version) {
    if (response.bodyBytes() > wholeAnswerBytes || version.isGone())
        return false;
    std::vector<BodyPart> filled;
    for (const BodyPart& part : response.body) {
        const auto* slice = sliceElsewhere(part);
        if (slice == nullptr) {
            filled.push_back(part);
            continue;
        }
        ByteRange range{slice->offset, slice->size};
        auto run = BlockCache::blocksOf(range);
        std::string bytes;
        for (std::uint64_t index = run.first; index < run.first + run.count; ++index) {
            Block block = version.held(index);
            if (!block)
                return false;
            appendTo(bytes, overlap(*block, index, range));
        }
        filled.push_back(std::move(bytes));
    }
    response.body = std::move(filled);
    return true;
}

Status writeRanges(HttpResponse response, UpstreamVersion& version, AnswerWriter& writer) {
    const std::atomic<bool>& stop = writer.isStopped();
    if (response.bodyBytes() <= wholeAnswerBytes) {
        std::string body;
        STIPPLE_CHECK(readParts(response, version, stop, [&body](ByteSpan bytes) {
            appendTo(body, bytes);
            return Status();
        }));
        response.body.clear();
        response.body.push_back(std::move(body));
        writer.answer(std::move(response));
        return {};
    }
    // Until the first bytes are here, an error is an answer of its own.
    auto first = std::find_if(response.body.begin(), response.body.end(),
                              [](const BodyPart& part) { return sliceElsewhere(part) != nullptr; });
    if (auto known = version.blocks({sliceElsewhere(*first)->offset / BlockCache::blockBytes, 1}, stop);
        !known)
        return known.error();
    bool hasBegun = false;
    Status status = readParts(response, version, stop, [&](ByteSpan bytes) -> Status {
        if (!hasBegun)
            STIPPLE_CHECK(writer.begin(response));
        hasBegun = true;
        return writer.write(bytes);
    });
    if (status || !hasBegun || status.error().code == ErrorCode::cancelled)
        return status;
    return Error{ErrorCode::networkFailed, status.error().what, status.error().where, ""};
}

} // namespace stipple::server
