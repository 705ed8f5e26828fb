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
    // A head and 64 KiB of a file.
    static constexpr std::size_t bufferBytes = 68 * 1024;
    using Buffer = std::unique_ptr<char[]>;
    Buffer take();
    void give(Buffer buffer);

  private:
    std::vector<Buffer> spare_;
};

// The head and what fits beside it of the body leave in one call, from a buffer of the pool. Files are read
// into it and looked at afterwards, so a file that was cut or written to since it was opened ends the body
// early: never padding, never bytes of another version. (sendfile only lends pages to the socket: what is cut
// off or overwritten before they have left goes to the client as zeros, or as the new bytes, in an answer
// that looks complete. A mapped file would be SIGBUS.) A client that is behind keeps no buffer, unless it is
// through TLS: what it has not taken is read again.
class ResponseSender {
  public:
    // 60 µs or so. With more, the slowest answers wait longer; with less, all take more processor time.
    static constexpr std::size_t stepBytes = 256 * 1024;

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
    void forgetUnsent();
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
    // How much is read at once: little while the client takes little, or most of it would be read in vain.
    std::size_t appetite_ = BufferPool::bufferBytes;
    struct Tail { // the end of the buffer
        bool isOfFile = false;
        std::size_t begin = 0, part = 0; // where it begins in the buffer; which part it is of
        std::uint64_t partBytes = 0;     // and from where on
    } tail_;
    Wait wait_ = Wait::nothing;
    SendOutcome outcome_;
};

} // namespace stipple::server
