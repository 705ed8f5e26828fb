// Sends a response: head, texts and parts of files, in as few system calls as they need. Our own, because
// Beast's file_body can't stop at the end of a range and reads 4 KiB at a time. A state machine, not a
// coroutine, so that an answer that the socket takes at once costs nothing more. Internal to server/net.
#pragma once

#include "server/http/message.hpp"
#include "server/net/stream.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace stipple::server {

struct SendOutcome {
    bool isComplete = false;
    std::uint64_t bodyBytes = 0; // that were handed to the socket
};

// Of fixed size, handed out again and again. Lives on one thread.
class BufferPool {
  public:
    // A head and 64 KiB of a file: measured on loopback, up to there copying costs no more than sendfile.
    static constexpr std::size_t bufferBytes = 68 * 1024;
    using Buffer = std::unique_ptr<char[]>;
    Buffer take();
    void give(Buffer buffer);

  private:
    std::vector<Buffer> spare_;
};

// The head and what fits beside it of the body leave in one call, from a buffer of the pool that is held
// until then. What is left of a file follows by sendfile, or through the buffer where there is TLS (a mapped
// file would be SIGBUS once it is cut). A file that was cut or written to since it was opened ends the body
// early: never padding, never bytes of another version.
class ResponseSender {
  public:
    static constexpr std::size_t stepBytes = 1024 * 1024; // 150 µs or so

    enum class Step {
        done, // outcome() says how
        wait, // for what waitsFor() says
        pause // a step's worth has left: let others have their turn
    };

    // All are kept by reference until it is done.
    ResponseSender(Stream& stream, BufferPool& pool, std::string_view head, const HttpResponse& response);
    ~ResponseSender();
    ResponseSender(const ResponseSender&) = delete;
    ResponseSender& operator=(const ResponseSender&) = delete;

    Step step();
    Wait waitsFor() const { return wait_; }
    const SendOutcome& outcome() const { return outcome_; }

  private:
    bool fill();
    bool fillFrom(const FileSlice& slice);
    bool flush();
    bool sendFile();
    void nextPart();
    bool isAtEnd() const { return part_ == partCount_; }
    Step end(bool isComplete);

    Stream& stream_;
    BufferPool& pool_;
    std::string_view head_; // what is not in the buffer yet
    const HttpResponse& response_;
    const std::size_t partCount_;
    std::size_t part_ = 0;        // being taken from
    std::uint64_t partBytes_ = 0; // of it, that are taken

    BufferPool::Buffer buffer_;
    std::size_t begin_ = 0, end_ = 0; // of the buffer: waiting to be sent
    std::size_t headBytes_ = 0;       // of those, that belong to the head
    std::size_t inStep_ = 0;
    const OpenFile* sentFrom_ = nullptr; // by sendfile: to be looked at once more at the end
    Wait wait_ = Wait::nothing;
    SendOutcome outcome_;
};

} // namespace stipple::server
