#include "client/web/decode_messages.hpp"

#include "client/web/entry_message.hpp"
#include "client/web/message_text.hpp"

#include <array>

namespace stipple::web {
namespace {

constexpr std::uint32_t jobMark = 0x324A4253;    // "SBJ2"
constexpr std::uint32_t answerMark = 0x31414253; // "SBA1"
constexpr std::uint32_t maxPoints = 1u << 28;    // four words each still fit the address space
constexpr std::uint64_t maxColumnBytes = 1ull << 31;
constexpr int wordArrayCount = nodeArrayCount - 1; // and the columns' values
static_assert(sizeof(NodeColumn) == 8);

Error damaged(Phrase what) {
    return {ErrorCode::corrupt, what, "decoding worker", say("reload the page")};
}

// With the values' size, to be filled.
Result<NodeColumns> readColumns(ByteReader& in, std::uint32_t points) {
    NodeColumns columns;
    std::uint32_t count = in.read<std::uint32_t>();
    std::uint64_t bytesPerPoint = 0;
    if (count > in.remaining() / sizeof(NodeColumn) || points > maxPoints)
        return damaged(say("an answer to a decoding job names more columns than it holds"));
    for (std::uint32_t i = 0; i < count; ++i) {
        NodeColumn column;
        column.attribute = in.read<std::int32_t>();
        column.bytesPerPoint = in.read<std::uint32_t>();
        bytesPerPoint += column.bytesPerPoint;
        columns.columns.push_back(column);
    }
    if (bytesPerPoint > 0 && points > maxColumnBytes / bytesPerPoint)
        return damaged(say("the attributes of a decoded node have the wrong length"));
    columns.pointCount = count > 0 ? points : 0;
    columns.values.resize(static_cast<std::size_t>(points * bytesPerPoint));
    return columns;
}

template <class T>
ByteSpan bytesOf(const std::vector<T>& values) {
    return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)};
}

} // namespace

Bytes encodeJob(const DecodeJob& job) {
    ByteWriter out;
    out.write(jobMark);
    out.write(job.cloud);
    writeEntry(out, job.entry);
    out.write(static_cast<std::int32_t>(job.strata));
    out.write(job.block);
    out.write(static_cast<std::uint32_t>(job.points.size()));
    for (std::uint32_t point : job.points)
        out.write(point);
    return out.take();
}

Result<DecodeJob> decodeJob(ByteSpan message) {
    ByteReader in(message);
    DecodeJob job;
    if (in.read<std::uint32_t>() != jobMark)
        return damaged(say("a message is no decoding job"));
    job.cloud = in.read<std::uint32_t>();
    if (!readEntry(in, job.entry))
        return damaged(say("a decoding job names more blocks than it holds"));
    job.strata = in.read<std::int32_t>();
    job.block = in.read<std::int32_t>();
    std::uint32_t points = in.read<std::uint32_t>();
    if (points > in.remaining() / sizeof(std::uint32_t))
        return damaged(say("a decoding job names more points than it holds"));
    job.points.resize(points);
    for (std::uint32_t& point : job.points)
        point = in.read<std::uint32_t>();
    if (!in.ok() || in.remaining() != 0 || job.strata < 0 || job.strata > strataCount)
        return damaged(say("a decoding job has the wrong length"));
    return job;
}

ByteSpan nodeArray(const ResidentNode& node, int index) {
    switch (index) {
    case 0:
        return bytesOf(node.positionWords);
    case 1:
        return bytesOf(node.positionLowWords);
    case 2:
        return bytesOf(node.colourWords);
    case 3:
        return node.columns.values;
    default:
        return {};
    }
}

std::uint8_t* nodeArrayBytes(ResidentNode& node, int index) {
    return const_cast<std::uint8_t*>(nodeArray(node, index).data());
}

Bytes encodeAnswer(const Result<ResidentNode>& answer) {
    ByteWriter out;
    out.write(answerMark);
    out.write(static_cast<std::uint8_t>(answer.ok()));
    if (!answer.ok()) {
        out.write(static_cast<std::uint8_t>(answer.error().code));
        writeText(out, answer.error().what.marked());
        writeText(out, answer.error().where);
        writeText(out, answer.error().advice.marked());
        return out.take();
    }
    const ResidentNode& node = answer.value();
    writeKey(out, node.key);
    out.write(static_cast<std::int32_t>(node.nodeBits));
    out.write(static_cast<std::int32_t>(node.positionShift));
    out.write(node.pointCount);
    out.write(node.totalPoints);
    out.write(node.shownUnit);
    for (int i = 0; i < wordArrayCount; ++i)
        out.write(static_cast<std::uint32_t>(nodeArray(node, i).size() / 4));
    out.write(static_cast<std::uint32_t>(node.columns.columns.size()));
    for (const NodeColumn& column : node.columns.columns) {
        out.write(column.attribute);
        out.write(column.bytesPerPoint);
    }
    return out.take();
}

Result<ResidentNode> decodeAnswer(ByteSpan message) {
    ByteReader in(message);
    if (in.read<std::uint32_t>() != answerMark)
        return damaged(say("a message is no answer to a decoding job"));
    if (in.read<std::uint8_t>() == 0) {
        Error error;
        error.code = static_cast<ErrorCode>(in.read<std::uint8_t>());
        error.what = readText(in);
        error.where = readText(in);
        error.advice = readText(in);
        return in.ok() && error.code <= ErrorCode::cancelled ? error
                                                             : damaged(say("an error message is cut"));
    }
    ResidentNode node;
    node.key = readKey(in);
    node.nodeBits = in.read<std::int32_t>();
    node.positionShift = in.read<std::int32_t>();
    node.pointCount = in.read<std::uint32_t>();
    node.totalPoints = in.read<std::uint32_t>();
    node.shownUnit = in.read<std::uint32_t>();
    std::array<std::uint32_t, wordArrayCount> counts{};
    for (std::uint32_t& count : counts)
        count = in.read<std::uint32_t>();
    STIPPLE_TRY(columns, readColumns(in, node.pointCount));
    if (!in.ok() || in.remaining() != 0 || node.pointCount > maxPoints)
        return damaged(say("an answer to a decoding job has the wrong length"));
    // An array is whole or absent: a job for attributes alone has no positions.
    const std::array<std::uint32_t, wordArrayCount> whole{2 * node.pointCount, node.pointCount,
                                                          node.pointCount};
    for (std::size_t i = 0; i < counts.size(); ++i)
        if (counts[i] != 0 && counts[i] != whole[i])
            return damaged(say("an array of a decoded node has the wrong length"));
    node.positionWords.resize(counts[0]);
    node.positionLowWords.resize(counts[1]);
    node.colourWords.resize(counts[2]);
    node.columns = std::move(columns);
    return node;
}

} // namespace stipple::web
