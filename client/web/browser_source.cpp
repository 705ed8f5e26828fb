#include "client/web/browser_source.hpp"

#include "client/web/host.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <optional>
#include <unordered_map>

namespace stipple::web {
namespace {

class BrowserSource;

// Requests of all sources share one numbering, so that the page needs to know nothing else.
std::unordered_map<std::uint32_t, BrowserSource*>& owners() {
    static std::unordered_map<std::uint32_t, BrowserSource*> requests;
    return requests;
}

std::uint32_t nextRequest() {
    static std::uint32_t last = 0;
    return ++last;
}

class BrowserSource : public ByteSource {
  public:
    explicit BrowserSource(std::string name) : name_(std::move(name)) {}
    ~BrowserSource() override {
        while (!reads_.empty())
            cancel(reads_.begin()->first);
        pump({});
    }
    BrowserSource(const BrowserSource&) = delete;
    BrowserSource& operator=(const BrowserSource&) = delete;

    RequestId read(ByteRange range, Completion done) override {
        std::uint32_t request = nextRequest();
        if (range.size == 0) {
            arrived_.push_back({request, std::move(done), Bytes{}});
            return request;
        }
        reads_.emplace(request, Read{range, std::move(done), {}});
        owners().emplace(request, this);
        start(request, range);
        return request;
    }

    void cancel(RequestId id) override {
        auto request = static_cast<std::uint32_t>(id);
        if (!reads_.contains(request))
            return;
        stippleHostAbort(request);
        answer(request, Error{ErrorCode::cancelled, say("the read was taken back"), name_, ""});
    }

    int pump(std::chrono::milliseconds) override {
        int delivered = 0;
        for (std::size_t waiting = arrived_.size(); waiting > 0 && !arrived_.empty(); --waiting) {
            Arrival arrival = std::move(arrived_.front());
            arrived_.pop_front();
            ++delivered;
            arrival.done(std::move(arrival.result));
        }
        return delivered;
    }

    Progress progress(RequestId id) const override {
        auto read = reads_.find(static_cast<std::uint32_t>(id));
        if (read == reads_.end())
            return {};
        return {read->second.begunAt.has_value(), read->second.bytesHere, read->second.begunAt};
    }

    std::string name() const override { return name_; }

    virtual Result<std::uint64_t> accept(ByteRange asked, const RangeAnswer& answer) = 0;
    virtual void markStored() {}

    double acceptHeaders(std::uint32_t request, const RangeAnswer& headers) {
        Read& read = reads_.at(request);
        Result<std::uint64_t> judged = accept(read.range, headers);
        if (!judged.ok()) {
            stippleHostAbort(request);
            answer(request, judged.error());
            return -1;
        }
        read.body.resize(static_cast<std::size_t>(*judged));
        read.begunAt = std::chrono::steady_clock::now();
        return static_cast<double>(*judged);
    }

    std::uint8_t* bodyBuffer(std::uint32_t request, std::size_t size) {
        Read& read = reads_.at(request);
        if (size > read.body.size() - read.bytesHere) {
            stippleHostAbort(request);
            fail(request, ReadFailure::longBody, "");
            return nullptr;
        }
        read.bytesHere += size;
        return read.body.data() + (read.bytesHere - size);
    }

    void finishBody(std::uint32_t request) {
        Read& read = reads_.at(request);
        if (read.bytesHere < read.body.size())
            return fail(request, ReadFailure::shortBody, "");
        answer(request, std::move(read.body));
    }

    void fail(std::uint32_t request, ReadFailure failure, const std::string& detail) {
        answer(request, errorOf(failure, detail));
    }

  protected:
    struct Read {
        ByteRange range;
        Completion done;
        Bytes body;
        std::size_t bytesHere = 0; // of the body
        std::optional<std::chrono::steady_clock::time_point> begunAt = {};
    };
    virtual void start(std::uint32_t request, ByteRange range) = 0;
    void expectBody(std::uint32_t request, std::uint64_t size) {
        reads_.at(request).body.resize(static_cast<std::size_t>(size));
    }

    void answer(std::uint32_t request, Result<Bytes> result) {
        auto read = reads_.find(request);
        arrived_.push_back({request, std::move(read->second.done), std::move(result)});
        reads_.erase(read);
        owners().erase(request);
        stippleHostWake();
    }

    virtual bool wasReadBefore() const { return false; } // a first answer was accepted

  private:
    Error errorOf(ReadFailure failure, const std::string& detail) const {
        switch (failure) {
        case ReadFailure::shortBody:
            return {ErrorCode::truncated, say("the server closed the connection before the end"), name_,
                    say("try again; if it goes on, the file or a proxy on the way is damaged")};
        case ReadFailure::longBody:
            return {ErrorCode::networkFailed, say("the server sent more bytes than it announced"), name_, ""};
        case ReadFailure::fileGone:
            return {ErrorCode::changed, say("the file can't be read any more: ", detail), name_,
                    say("drop it on the page again")};
        case ReadFailure::notAllowed:
            return notAllowedError(detail);
        case ReadFailure::mixedContent:
            return {ErrorCode::unsupported,
                    say("a page that came over https may not read from an http address"), name_,
                    say("give the cloud by https, or open the page by http; nothing was asked for")};
        case ReadFailure::notPrepared:
            return {ErrorCode::networkFailed, say("the page could not prepare the request: ", detail), name_,
                    say("it is this page's prepareRequest that failed")};
        case ReadFailure::network:
            break;
        }
        return {ErrorCode::networkFailed, say("the server can't be reached: ", detail), name_,
                say("is the address right, the server running, this machine online?")};
    }

    // Browsers hide an answer from a page that its server does not allow to read it. A server that did before
    // has an error now (proxies often leave the field out of their own answers); another never will.
    Error notAllowedError(const std::string& origin) const {
        if (wasReadBefore())
            return {
                ErrorCode::networkFailed, say("the server's answer was hidden from this page"), name_,
                say("most likely an error of the server, which came without Access-Control-Allow-Origin")};
        return {ErrorCode::unsupported,
                say("the server is there, but does not allow this page to read the file"), name_,
                say("it must send Access-Control-Allow-Origin: ", origin,
                    " (or *) and Access-Control-Expose-Headers: Content-Range, ETag, Retry-After; for tokens "
                    "also Access-Control-Allow-Headers: Authorization, Range")};
    }

    struct Arrival {
        std::uint32_t request;
        Completion done;
        Result<Bytes> result;
    };
    std::string name_;
    std::map<std::uint32_t, Read> reads_;
    std::deque<Arrival> arrived_;
};

class FetchSource final : public BrowserSource {
  public:
    explicit FetchSource(const std::string& url) : BrowserSource(url) {}
    std::uint64_t sizeBytes() const override { return version_.sizeBytes; }
    std::string caution() const override { return versionCaution(version_); }
    bool readsOverGaps() const override { return !isStored_; }
    void markStored() override { isStored_ = true; }

  private:
    bool wasReadBefore() const override { return version_.pinned; }
    bool forgetVersion() override {
        version_ = {};
        isStored_ = false;
        return true;
    }
    void start(std::uint32_t request, ByteRange range) override {
        stippleHostFetch(request, name().c_str(), rangeField(range).c_str());
    }
    Result<std::uint64_t> accept(ByteRange asked, const RangeAnswer& headers) override {
        return judgeRangeAnswer(asked, headers, version_, name());
    }
    FileVersion version_;
    bool isStored_ = false; // in part, by an earlier visit
};

class FileSource final : public BrowserSource {
  public:
    FileSource(std::uint32_t file, const std::string& name, std::uint64_t sizeBytes)
        : BrowserSource(name), file_(file), sizeBytes_(sizeBytes) {}
    ~FileSource() override { stippleHostCloseFile(file_); }
    std::uint64_t sizeBytes() const override { return sizeBytes_; }

  private:
    void start(std::uint32_t request, ByteRange range) override {
        if (range.offset >= sizeBytes_) {
            answer(request,
                   Error{ErrorCode::truncated,
                         say("the file ends after ", sizeBytes_, " bytes, before byte ", range.offset),
                         name(), say("copy or convert it again")});
            return;
        }
        std::uint64_t size = std::min(range.size, sizeBytes_ - range.offset);
        expectBody(request, size);
        stippleHostReadFile(request, file_, static_cast<double>(range.offset), static_cast<double>(size));
    }
    Result<std::uint64_t> accept(ByteRange, const RangeAnswer&) override {
        return Error{ErrorCode::invalidArgument, say("a local file has no headers"), name(), ""};
    }
    std::uint32_t file_;
    std::uint64_t sizeBytes_;
};

BrowserSource* ownerOf(std::uint32_t request) {
    auto owner = owners().find(request);
    return owner == owners().end() ? nullptr : owner->second;
}

} // namespace

std::unique_ptr<ByteSource> makeFetchSource(const std::string& url) {
    return std::make_unique<FetchSource>(url);
}

std::unique_ptr<ByteSource> makeFileSource(std::uint32_t file, const std::string& name,
                                           std::uint64_t sizeBytes) {
    return std::make_unique<FileSource>(file, name, sizeBytes);
}

double acceptHeaders(std::uint32_t request, const RangeAnswer& answer) {
    BrowserSource* owner = ownerOf(request);
    return owner ? owner->acceptHeaders(request, answer) : -1;
}

void markStored(std::uint32_t request) {
    if (BrowserSource* owner = ownerOf(request))
        owner->markStored();
}

std::uint8_t* bodyBuffer(std::uint32_t request, std::size_t size) {
    BrowserSource* owner = ownerOf(request);
    return owner ? owner->bodyBuffer(request, size) : nullptr;
}

void finishBody(std::uint32_t request) {
    if (BrowserSource* owner = ownerOf(request))
        owner->finishBody(request);
}

void failRead(std::uint32_t request, ReadFailure failure, const std::string& detail) {
    if (BrowserSource* owner = ownerOf(request))
        owner->fail(request, failure, detail);
}

} // namespace stipple::web
