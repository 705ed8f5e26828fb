#include "client/web/worker_decoder.hpp"

#include "client/web/cloud_message.hpp"
#include "client/web/decode_messages.hpp"
#include "client/web/host.hpp"

namespace stipple::web {

void WorkerDecoder::decode(DecodeJob job, Completion done) {
    describe(job);
    std::uint32_t id = ++lastJob_;
    waiting_.emplace(id, Waiting{std::move(done), {}});
    Bytes message = encodeJob(job);
    const Bytes& first = job.strata > 0 ? job.picture : job.shown;
    stippleHostDecode(id, message.data(), message.size(), first.data(), first.size(), job.attributes.data(),
                      job.attributes.size());
}

int WorkerDecoder::pump(std::chrono::milliseconds) {
    int delivered = 0;
    for (std::size_t count = ready_.size(); count > 0 && !ready_.empty(); --count) {
        Ready next = std::move(ready_.front());
        ready_.pop_front();
        ++delivered;
        next.done(std::move(next.result));
    }
    return delivered;
}

bool WorkerDecoder::answer(std::uint32_t job, ByteSpan message) {
    auto waiting = waiting_.find(job);
    if (waiting == waiting_.end())
        return false;
    Result<ResidentNode> answer = decodeAnswer(message);
    if (!answer.ok()) {
        ready(job, answer.error());
        return false;
    }
    waiting->second.node = std::move(*answer);
    return true;
}

std::uint8_t* WorkerDecoder::arrayBytes(std::uint32_t job, int index, std::size_t sizeBytes) {
    ResidentNode& node = waiting_.at(job).node;
    return nodeArray(node, index).size() == sizeBytes ? nodeArrayBytes(node, index) : nullptr;
}

void WorkerDecoder::finish(std::uint32_t job) {
    ResidentNode node = std::move(waiting_.at(job).node);
    node.id = nextResidentNodeId(); // the worker's own number is unique in the worker only
    ready(job, std::move(node));
}

void WorkerDecoder::fail(std::uint32_t job, const std::string& detail) {
    if (waiting_.contains(job))
        ready(job, Error{ErrorCode::ioFailed, detail, "decoding worker", say("reload the page")});
}

void WorkerDecoder::forgetCloud(std::uint32_t cloud) {
    if (described_.erase(cloud) > 0)
        stippleHostForgetCloud(cloud);
}

void WorkerDecoder::describe(const DecodeJob& job) {
    auto& known = described_[job.cloud];
    if (known == job.metadata)
        return;
    known = job.metadata;
    Bytes message = encodeCloud(*job.metadata);
    stippleHostDescribeCloud(job.cloud, message.data(), message.size());
}

void WorkerDecoder::ready(std::uint32_t job, Result<ResidentNode> result) {
    auto waiting = waiting_.find(job);
    ready_.push_back({std::move(waiting->second.done), std::move(result)});
    waiting_.erase(waiting);
    stippleHostWake();
}

} // namespace stipple::web
