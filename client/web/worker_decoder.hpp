// The NodeDecoder of the page: jobs go to Web Workers (which run decodeNode, client/web/decoder_exports.cpp),
// answers wait here until pump() delivers them. The workers themselves belong to the page
// (www/src/wasm/decoder_pool.ts).
#pragma once

#include "client/core/node_decoder.hpp"
#include "shared/base/bytes.hpp"

#include <deque>
#include <map>

namespace stipple::web {

class WorkerDecoder final : public NodeDecoder {
  public:
    void decode(DecodeJob job, Completion done) override;
    int pump(std::chrono::milliseconds wait) override;
    std::size_t pending() const override { return waiting_.size() + ready_.size(); }

    // A worker answered. Its arrays are then put where arrayBytes() says (valid until the next call into
    // the program; null where the size is wrong), and finish() ends it. False: the answer was an error, or
    // the job is unknown; nothing is to be copied.
    bool answer(std::uint32_t job, ByteSpan message);
    std::uint8_t* arrayBytes(std::uint32_t job, int index, std::size_t sizeBytes);
    void finish(std::uint32_t job);
    // The worker itself failed (it ran out of memory, or its program did not load).
    void fail(std::uint32_t job, const std::string& detail);

    void forgetCloud(std::uint32_t cloud);

  private:
    struct Waiting {
        Completion done;
        ResidentNode node;
    };
    struct Ready {
        Completion done;
        Result<ResidentNode> result;
    };
    void describe(const DecodeJob& job);
    void ready(std::uint32_t job, Result<ResidentNode> result);

    std::uint32_t lastJob_ = 0;
    std::map<std::uint32_t, Waiting> waiting_;
    std::deque<Ready> ready_;
    std::map<std::uint32_t, std::shared_ptr<const CloudMetadata>> described_;
};

} // namespace stipple::web
