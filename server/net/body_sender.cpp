#include "server/net/body_sender.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <cerrno>
#include <cstring>
#include <sys/sendfile.h>

namespace stipple::server {

namespace {

namespace net = boost::asio;
using Socket = net::ip::tcp::socket;
constexpr auto answered = net::as_tuple(net::use_awaitable);
constexpr std::size_t pieceBytes = 256 * 1024;

// Asio would write at most 64 KiB in one call, which splits head and body.
std::size_t allAtOnce(const boost::system::error_code& error, std::size_t) {
    return error ? 0 : pieceBytes + Loop::bufferBytes;
}

class BodySender {
  public:
    BodySender(Loop& loop, Socket& socket, std::string head, std::function<void()> onProgress)
        : loop_(loop), socket_(socket), head_(std::move(head)), onProgress_(std::move(onProgress)) {}

    net::awaitable<SendOutcome> send(const HttpResponse& response) {
        if (response.sendsBody)
            for (const BodyPart& part : response.body) {
                const auto* slice = std::get_if<FileSlice>(&part);
                // Plain statements: GCC 12 miscompiles co_await in ?: and &&.
                bool sent = false;
                if (slice != nullptr)
                    sent = co_await sendSlice(*slice);
                else
                    sent = co_await sendText(std::get<std::string>(part));
                if (!sent)
                    co_return outcome_;
            }
        outcome_.isComplete = true;
        if (!head_.empty())
            outcome_.isComplete = co_await write(std::string_view());
        co_return outcome_;
    }

  private:
    // Short texts (a problem document, the header of a part) wait for what follows them.
    net::awaitable<bool> sendText(const std::string& text) {
        if (head_.size() + text.size() <= Loop::bufferBytes) {
            head_ += text;
            pendingBodyBytes_ += text.size();
            co_return true;
        }
        co_return co_await write(text);
    }

    net::awaitable<bool> sendSlice(FileSlice slice) {
        if (slice.size == 0)
            co_return true;
        if (!head_.empty()) {
            std::size_t size =
                static_cast<std::size_t>(std::min<std::uint64_t>(slice.size, Loop::bufferBytes));
            std::vector<char> buffer = loop_.takeBuffer();
            bool sent = slice.file->readAt(slice.offset, buffer.data(), size) && slice.file->isUnchanged();
            if (sent)
                sent = co_await write(std::string_view(buffer.data(), size));
            loop_.giveBuffer(std::move(buffer));
            if (!sent)
                co_return false;
            slice.offset += size;
            slice.size -= size;
        }
        co_return co_await sendRest(slice);
    }

    // What was held back, and `text`, in one call.
    net::awaitable<bool> write(std::string_view text) {
        onProgress_();
        std::array<net::const_buffer, 2> buffers{net::buffer(head_), net::buffer(text.data(), text.size())};
        auto [error, written] = co_await net::async_write(socket_, buffers, allAtOnce, answered);
        std::size_t headBytes = head_.size() - pendingBodyBytes_;
        outcome_.bodyBytes += written > headBytes ? written - headBytes : 0;
        head_.clear();
        pendingBodyBytes_ = 0;
        co_return !error;
    }

    net::awaitable<bool> sendRest(FileSlice slice) {
        std::uint64_t untilProgress = 0;
        while (slice.size > 0) {
            if (untilProgress == 0) {
                if (!slice.file->isUnchanged())
                    co_return false;
                onProgress_();
                // A client as fast as this loop must not keep the other connections waiting.
                co_await net::post(socket_.get_executor(), net::use_awaitable);
                untilProgress = std::min<std::uint64_t>(slice.size, pieceBytes);
            }
            off_t at = static_cast<off_t>(slice.offset);
            ssize_t sent = ::sendfile(socket_.native_handle(), slice.file->descriptor(), &at,
                                      static_cast<std::size_t>(untilProgress));
            if (sent > 0) {
                auto count = static_cast<std::uint64_t>(sent);
                outcome_.bodyBytes += count;
                slice.offset += count;
                slice.size -= count;
                untilProgress -= count;
            } else if (sent < 0 && errno == EAGAIN) {
                if (auto [error] = co_await socket_.async_wait(Socket::wait_write, answered); error)
                    co_return false;
            } else if (sent == 0 || errno != EINTR) {
                co_return false; // the file ended early, or the client left
            }
        }
        co_return true;
    }

    Loop& loop_;
    Socket& socket_;
    std::string head_;                 // not sent yet; after the response's head, short texts of the body
    std::size_t pendingBodyBytes_ = 0; // of head_, that belong to the body
    std::function<void()> onProgress_;
    SendOutcome outcome_;
};

} // namespace

net::awaitable<SendOutcome> sendResponse(Loop& loop, Socket& socket, std::string head,
                                         const HttpResponse& response, std::function<void()> onProgress) {
    BodySender sender(loop, socket, std::move(head), std::move(onProgress));
    co_return co_await sender.send(response);
}

} // namespace stipple::server
