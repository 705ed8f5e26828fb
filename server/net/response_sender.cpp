#include "server/net/response_sender.hpp"

#include <algorithm>
#include <cstring>

namespace stipple::server {

namespace {
constexpr std::size_t leastRead = 16 * 1024;
} // namespace

BufferPool::Buffer BufferPool::take() {
    if (spare_.empty())
        return Buffer(new char[bufferBytes]); // not zeroed, as make_unique would
    Buffer buffer = std::move(spare_.back());
    spare_.pop_back();
    return buffer;
}

void BufferPool::give(Buffer buffer) {
    constexpr std::size_t kept = 16; // 1 MiB; more are in use only while clients are slow
    if (spare_.size() < kept)
        spare_.push_back(std::move(buffer));
}

ResponseSender::ResponseSender(Stream& stream, BufferPool& pool, std::string_view head,
                               const HttpResponse& response)
    : stream_(stream), pool_(pool), head_(head), response_(response),
      partCount_(response.sendsBody ? response.body.size() : 0) {}

ResponseSender::~ResponseSender() {
    if (buffer_)
        pool_.give(std::move(buffer_));
}

ResponseSender::Step ResponseSender::step() {
    inStep_ = 0;
    for (;;) {
        if (begin_ == end_ && !fill())
            return end(false); // a file is not what it was
        bool goesOn = begin_ == end_ || flush();
        if (begin_ == end_)
            appetite_ = std::min(2 * appetite_, BufferPool::bufferBytes);
        if (begin_ == end_ && isAtEnd())
            return end(true);
        if (wait_ == Wait::never)
            return end(false);
        if (!goesOn || inStep_ >= stepBytes)
            forgetUnsent();
        if (!goesOn)
            return Step::wait;
        if (inStep_ >= stepBytes)
            return Step::pause;
    }
}

ResponseSender::Step ResponseSender::end(bool isComplete) {
    outcome_.isComplete = isComplete;
    return Step::done;
}

// Puts into the buffer what comes next, until it is full.
bool ResponseSender::fill() {
    begin_ = end_ = headBytes_ = 0;
    tail_ = {};
    auto append = [this](std::string_view text) {
        if (!buffer_)
            buffer_ = pool_.take();
        std::size_t count = std::min(text.size(), BufferPool::bufferBytes - end_);
        std::memcpy(buffer_.get() + end_, text.data(), count);
        end_ += count;
        return count;
    };
    if (!head_.empty()) {
        headBytes_ = append(head_);
        head_.remove_prefix(headBytes_);
    }
    while (!isAtEnd() && end_ < appetite_) {
        const BodyPart& part = response_.body[part_];
        if (const auto* slice = std::get_if<FileSlice>(&part)) {
            if (!fillFrom(*slice))
                return false;
        } else {
            const auto& text = std::get<std::string>(part);
            tail_ = {};
            partBytes_ += append(std::string_view(text).substr(static_cast<std::size_t>(partBytes_)));
            if (partBytes_ == text.size())
                nextPart();
        }
    }
    return true;
}

bool ResponseSender::fillFrom(const FileSlice& slice) {
    if (!buffer_)
        buffer_ = pool_.take();
    std::uint64_t left = slice.size - partBytes_;
    auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left, appetite_ - end_));
    if (count > 0 && !(slice.file->readAt(slice.offset + partBytes_, buffer_.get() + end_, count) &&
                       slice.file->isUnchanged()))
        return false;
    tail_ = {true, end_, part_, partBytes_};
    end_ += count;
    partBytes_ += count;
    if (partBytes_ == slice.size)
        nextPart();
    return true;
}

// What is only a file's in the buffer can be read again: slow clients of large files must not keep it.
void ResponseSender::forgetUnsent() {
    if (begin_ < end_) {
        if (!tail_.isOfFile || begin_ < tail_.begin || !stream_.mayWriteAnew())
            return;
        appetite_ = std::clamp(inStep_, leastRead, BufferPool::bufferBytes);
        part_ = tail_.part;
        partBytes_ = tail_.partBytes + (begin_ - tail_.begin);
        begin_ = end_ = headBytes_ = 0;
    }
    if (buffer_)
        pool_.give(std::move(buffer_));
}

void ResponseSender::nextPart() {
    ++part_;
    partBytes_ = 0;
}

bool ResponseSender::flush() {
    Moved moved = stream_.write({buffer_.get() + begin_, end_ - begin_});
    wait_ = moved.wait;
    std::size_t ofHead = std::min(headBytes_, moved.bytes);
    headBytes_ -= ofHead;
    outcome_.bodyBytes += moved.bytes - ofHead;
    begin_ += moved.bytes;
    inStep_ += moved.bytes;
    return wait_ == Wait::nothing;
}

} // namespace stipple::server
