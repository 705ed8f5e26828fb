// A byte source that does what a test says: it answers from a buffer, at once or when told to, and fails the
// reads that the test wants to fail. Deterministic; nothing happens by itself.
#pragma once

#include "shared/io/byte_source.hpp"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace stipple::test {

// What the test holds of a source that a session owns.
struct SourceScript {
    Bytes file;
    bool holdAnswers = false;                               // answers wait until it is false
    std::function<std::optional<Error>(ByteRange)> failure; // asked when a read is answered
    std::vector<ByteRange> reads;                           // in the order in which they were asked for
    int cancelled = 0;
    std::size_t waiting = 0; // reads without an answer
    std::size_t mostWaiting = 0;
    std::uint64_t bytesWaiting = 0, mostBytesWaiting = 0;
    bool destroyed = false;
};

class ScriptedSource final : public ByteSource {
  public:
    explicit ScriptedSource(std::shared_ptr<SourceScript> script) : script_(std::move(script)) {}
    ~ScriptedSource() override {
        while (!open_.empty())
            cancel(open_.begin()->first);
        script_->destroyed = true;
    }

    RequestId read(ByteRange range, Completion done) override {
        script_->reads.push_back(range);
        open_[++last_] = {range, std::move(done)};
        count(+1, range);
        return last_;
    }

    void cancel(RequestId id) override {
        if (open_.count(id)) {
            ++script_->cancelled;
            answer(id, Error{ErrorCode::cancelled, "cancelled", name(), ""});
        }
    }

    int pump(std::chrono::milliseconds) override {
        int delivered = 0;
        RequestId newest = last_;
        while (!script_->holdAnswers && !open_.empty() && open_.begin()->first <= newest) {
            RequestId id = open_.begin()->first;
            answer(id, answerTo(open_.at(id).range));
            ++delivered;
        }
        return delivered;
    }

    std::uint64_t sizeBytes() const override { return script_->file.size(); }
    std::string name() const override { return "scripted.stipple"; }

  private:
    struct Open {
        ByteRange range;
        Completion done;
    };

    void count(int reads, ByteRange range) {
        script_->waiting += static_cast<std::size_t>(reads);
        script_->bytesWaiting += reads > 0 ? range.size : 0 - range.size;
        script_->mostWaiting = std::max(script_->mostWaiting, script_->waiting);
        script_->mostBytesWaiting = std::max(script_->mostBytesWaiting, script_->bytesWaiting);
    }

    Result<Bytes> answerTo(ByteRange range) const {
        if (script_->failure)
            if (auto error = script_->failure(range))
                return *error;
        const Bytes& file = script_->file;
        if (range.offset >= file.size())
            return Error{ErrorCode::truncated, "past the end", name(), ""};
        auto from = file.begin() + static_cast<std::ptrdiff_t>(range.offset);
        auto size = std::min<std::uint64_t>(range.size, file.size() - range.offset);
        return Bytes(from, from + static_cast<std::ptrdiff_t>(size));
    }

    void answer(RequestId id, Result<Bytes> result) {
        Open open = std::move(open_.at(id));
        open_.erase(id);
        count(-1, open.range);
        open.done(std::move(result));
    }

    std::shared_ptr<SourceScript> script_;
    std::map<RequestId, Open> open_;
    RequestId last_ = 0;
};

} // namespace stipple::test
