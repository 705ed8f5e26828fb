#include "client/web/browser_source.hpp"

#include "client/web/host.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <deque>
#include <map>
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
        reads_.emplace(request, Read{range, std::move(done), {}, false});
        owners().emplace(request, this);
        start(request, range);
        return request;
    }

    void cancel(RequestId id) override {
        auto request = static_cast<std::uint32_t>(id);
        if (!reads_.contains(request))
            return;
        stippleHostAbort(request);
        answer(request, Error{ErrorCode::cancelled, "the read was taken back", name_, ""});
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

    // The page puts a body down as a whole, so only its beginning is known.
    Progress progress(RequestId id) const override {
        auto read = reads_.find(static_cast<std::uint32_t>(id));
        return {read != reads_.end() && read->second.hasBegun, 0};
    }

    std::string name() const override { return name_; }

    virtual Result<std::uint64_t> accept(ByteRange asked, const RangeAnswer& answer) = 0;

    double acceptHeaders(std::uint32_t request, const RangeAnswer& headers) {
        Read& read = reads_.at(request);
        Result<std::uint64_t> judged = accept(read.range, headers);
        if (!judged.ok()) {
            stippleHostAbort(request);
            answer(request, judged.error());
            return -1;
        }
        read.body.resize(static_cast<std::size_t>(*judged));
        read.hasBegun = true;
        return static_cast<double>(*judged);
    }

    std::uint8_t* bodyBuffer(std::uint32_t request, double size) {
        Bytes& body = reads_.at(request).body;
        return size == static_cast<double>(body.size()) ? body.data() : nullptr;
    }

    void finishBody(std::uint32_t request) { answer(request, std::move(reads_.at(request).body)); }

    void fail(std::uint32_t request, ReadFailure failure, const std::string& detail) {
        answer(request, errorOf(failure, detail));
    }

  protected:
    struct Read {
        ByteRange range;
        Completion done;
        Bytes body;
        bool hasBegun = false;
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

  private:
    Error errorOf(ReadFailure failure, const std::string& detail) const {
        switch (failure) {
        case ReadFailure::shortBody:
            return {ErrorCode::truncated, "the server closed the connection before the end", name_,
                    "try again"};
        case ReadFailure::longBody:
            return {ErrorCode::networkFailed, "the server sent more bytes than it announced", name_, ""};
        case ReadFailure::fileGone:
            return {ErrorCode::changed, cat("the file can't be read any more: ", detail), name_,
                    "drop it on the page again"};
        case ReadFailure::network:
            break;
        }
        return {ErrorCode::networkFailed, cat("the server can't be reached: ", detail), name_,
                "is it running? From another host, does it send Access-Control-Allow-Origin?"};
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

  private:
    bool forgetVersion() override {
        version_ = {};
        return true;
    }
    void start(std::uint32_t request, ByteRange range) override {
        stippleHostFetch(request, name().c_str(), rangeField(range).c_str());
    }
    Result<std::uint64_t> accept(ByteRange asked, const RangeAnswer& headers) override {
        return judgeRangeAnswer(asked, headers, version_, name());
    }
    FileVersion version_;
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
                         cat("the file ends after ", sizeBytes_, " bytes, before byte ", range.offset),
                         name(), "copy or convert it again"});
            return;
        }
        std::uint64_t size = std::min(range.size, sizeBytes_ - range.offset);
        expectBody(request, size);
        stippleHostReadFile(request, file_, static_cast<double>(range.offset), static_cast<double>(size));
    }
    Result<std::uint64_t> accept(ByteRange, const RangeAnswer&) override {
        return Error{ErrorCode::invalidArgument, "a local file has no headers", name(), ""};
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

std::uint8_t* bodyBuffer(std::uint32_t request, double size) {
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
