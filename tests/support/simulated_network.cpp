#include "tests/support/simulated_network.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <list>
#include <vector>

namespace stipple::test {

namespace {

using Time = SimulatedNetwork::Time;
using Duration = SimulatedNetwork::Duration;
constexpr double nothing = 1e-6; // bytes: what rounding leaves

Duration durationOf(double bytes, double bytesPerSecond) {
    return Duration(static_cast<std::int64_t>(std::ceil(bytes / bytesPerSecond * 1e9)));
}

} // namespace

class SimulatedNetwork::Link {
  public:
    struct Connection {
        double window, left; // bytes it may carry in a round trip; of the present one
        double carried = 0;  // in the present one
        Time roundEnds{};
    };
    using ConnectionPtr = std::shared_ptr<Connection>;

    struct Request {
        ByteSource::RequestId id = 0;
        ByteRange range;
        std::shared_ptr<const HostedFile> file;
        std::function<void(Result<Bytes>)> ready; // called once, inside advance()
        std::function<Result<std::uint64_t>(const RangeAnswer&)> judge;
        bool isWaiting = true; // for a connection
        bool isFlowing = false;
        Time flowsAt{}; // first byte; or, silent: given up
        double left = 0, arrived = 0;
        ConnectionPtr connection;
        std::optional<Fault> fault;
        Result<Bytes> result = Bytes{};
        std::optional<Time> endsAt; // taken back: nothing more comes after this
    };
    using RequestPtr = std::shared_ptr<Request>;

    explicit Link(const NetworkOptions& options) : options_(options) {}

    NetworkCounters counters;
    std::function<std::optional<Fault>(std::uint64_t, ByteRange)> fault;
    Time now{};
    std::size_t readyToPump = 0;

    void add(const RequestPtr& request) {
        requests_.push_back(request);
        connect();
    }

    void takeBack(const RequestPtr& request) {
        if (!request->isWaiting)
            --connectionsInUse_;
        counters.bytesWasted += static_cast<std::uint64_t>(request->arrived);
        if (request->isFlowing)
            request->endsAt = now + options_.roundTrip / 2;
        else
            requests_.remove(request);
        connect();
    }

    // One step, to the next thing that happens or to `until`.
    void step(Time until) {
        share();
        Time next = until;
        for (const RequestPtr& request : requests_)
            next = std::min(next, nextOf(*request));
        carry(next);
        now = next;
        std::vector<RequestPtr> all(requests_.begin(), requests_.end());
        for (const RequestPtr& request : all)
            happen(request);
        connect();
    }

    ByteSource::Progress progress(const Request& request) const {
        return {request.isFlowing && request.arrived > nothing,
                static_cast<std::uint64_t>(std::max(0.0, request.arrived - options_.headerBytes))};
    }

  private:
    double bytesPerSecond() const { return options_.megabitsPerSecond * 1e6 / 8; }
    static bool isSilent(const Request& request) {
        return request.fault && request.fault->kind == Fault::Kind::silence;
    }

    // Requests that wait get what connections are free, in their order.
    void connect() {
        for (const RequestPtr& request : requests_) {
            if (!request->isWaiting || connectionsInUse_ >= options_.connections)
                continue;
            ++connectionsInUse_;
            request->isWaiting = false;
            request->flowsAt = now + options_.roundTrip;
            if (idle_.empty()) {
                ++counters.connectionsOpened;
                request->connection = std::make_shared<Connection>(
                    Connection{options_.firstWindowBytes, options_.firstWindowBytes});
                request->flowsAt += options_.handshakeRoundTrips * options_.roundTrip;
            } else {
                request->connection = idle_.back();
                idle_.pop_back();
            }
        }
    }

    bool mayCarry(const Request& request) const {
        return request.isFlowing && request.left > nothing && request.connection->left > nothing;
    }

    // Evenly among those that carry.
    void share() {
        auto carrying = std::count_if(requests_.begin(), requests_.end(),
                                      [&](const RequestPtr& request) { return mayCarry(*request); });
        rate_ = carrying > 0 ? bytesPerSecond() / static_cast<double>(carrying) : 0;
    }

    Time nextOf(const Request& request) const {
        if (request.isWaiting)
            return Time::max();
        if (!request.isFlowing)
            return request.flowsAt;
        Time next = request.endsAt.value_or(Time::max());
        if (request.left <= nothing)
            return request.endsAt ? next : now;
        next = std::min(next, request.connection->roundEnds);
        if (mayCarry(request))
            next = std::min(next, now + durationOf(std::min(request.left, request.connection->left), rate_));
        return next;
    }

    void carry(Time until) {
        double most = rate_ * std::chrono::duration<double>(until - now).count();
        for (const RequestPtr& request : requests_) {
            if (!mayCarry(*request))
                continue;
            Connection& connection = *request->connection;
            double bytes = std::min({most, request->left, connection.left});
            request->left -= bytes;
            request->arrived += bytes;
            connection.left -= bytes;
            connection.carried += bytes;
            carried_ += bytes;
            if (request->endsAt)
                wastedAfter_ += bytes;
        }
        counters.bytesCarried = static_cast<std::uint64_t>(carried_);
        counters.bytesWasted += static_cast<std::uint64_t>(wastedAfter_);
        wastedAfter_ -= std::floor(wastedAfter_);
    }

    void happen(const RequestPtr& request) {
        if (request->endsAt && *request->endsAt <= now) {
            requests_.remove(request);
            return;
        }
        if (request->isWaiting)
            return;
        if (!request->isFlowing && request->flowsAt <= now)
            reach(*request);
        if (!request->isFlowing)
            return;
        Connection& connection = *request->connection;
        if (connection.roundEnds <= now) {
            connection.window = std::min(connection.window + connection.carried, options_.mostWindowBytes);
            connection.left = connection.window;
            connection.carried = 0;
            connection.roundEnds = now + std::max<Duration>(options_.roundTrip, Duration(1000));
        }
        if (request->left <= nothing && !request->endsAt)
            end(request);
    }

    // The server answers. (A silent one: time has run out.)
    void reach(Request& request) {
        if (isSilent(request)) {
            request.result = noAnswerInTime("");
            request.isFlowing = true;
            request.left = 0;
            return;
        }
        ++counters.requests;
        request.fault = fault ? fault(counters.requests, request.range) : std::nullopt;
        if (isSilent(request)) {
            request.flowsAt = now + options_.timeout;
            return;
        }
        RangeAnswer head = headOf(request);
        Result<std::uint64_t> size = request.judge(head);
        request.isFlowing = true;
        request.left = options_.headerBytes;
        if (!size.ok()) {
            request.result = size.error();
            return;
        }
        request.result = bodyOf(request, *size);
        request.left += static_cast<double>(*size);
        if (request.fault && request.fault->kind == Fault::Kind::reset) {
            request.left *= request.fault->part;
            request.result =
                Error{ErrorCode::networkFailed,
                      "the server closed the connection in the middle of its answer", "", "try again"};
        }
    }

    RangeAnswer headOf(const Request& request) const {
        RangeAnswer head;
        const HostedFile& file = *request.file;
        std::uint64_t size = file.bytes.size();
        head.etag = file.etag;
        if (request.fault && request.fault->kind == Fault::Kind::status) {
            head.status = request.fault->status;
            head.etag.clear();
            head.retryAfter = request.fault->retryAfter;
        } else if (request.fault && request.fault->kind == Fault::Kind::wholeFile) {
            head.status = 200;
            head.contentLength = size;
        } else if (request.range.offset >= size) {
            head.status = 416;
            head.contentRange = "bytes */" + std::to_string(size);
        } else {
            head.status = 206;
            std::uint64_t end = std::min(request.range.end(), size);
            head.contentRange = "bytes " + std::to_string(request.range.offset) + "-" +
                                std::to_string(end - 1) + "/" + std::to_string(size);
        }
        return head;
    }

    static Bytes bodyOf(const Request& request, std::uint64_t size) {
        auto from = request.file->bytes.begin() + static_cast<std::ptrdiff_t>(request.range.offset);
        Bytes body(from, from + static_cast<std::ptrdiff_t>(size));
        if (request.fault && request.fault->kind == Fault::Kind::corruptBody && !body.empty())
            body[std::min(body.size() - 1,
                          static_cast<std::size_t>(request.fault->part * static_cast<double>(size)))] ^= 0x5A;
        return body;
    }

    void end(const RequestPtr& request) {
        bool isBroken = !request->result.ok() && request->result.error().code == ErrorCode::networkFailed &&
                        request->fault && request->fault->kind != Fault::Kind::status;
        if (isBroken)
            counters.bytesWasted += static_cast<std::uint64_t>(request->arrived);
        else
            idle_.push_back(request->connection);
        --connectionsInUse_;
        requests_.remove(request);
        ++readyToPump;
        request->ready(std::move(request->result));
    }

    const NetworkOptions options_;
    std::list<RequestPtr> requests_; // in the order in which they were asked for
    std::vector<ConnectionPtr> idle_;
    int connectionsInUse_ = 0;
    double rate_ = 0; // bytes a second, of each answer that is on the link
    double carried_ = 0, wastedAfter_ = 0;
};

class SimulatedNetwork::Source final : public ByteSource {
  public:
    Source(std::shared_ptr<Link> link, std::shared_ptr<const HostedFile> file, std::string name)
        : link_(std::move(link)), file_(std::move(file)), name_(std::move(name)) {}

    ~Source() override {
        while (!open_.empty())
            cancel(open_.front().request->id);
        pump({});
    }

    RequestId read(ByteRange range, Completion done) override {
        auto request = std::make_shared<Link::Request>();
        request->id = ++last_;
        request->range = range;
        request->file = file_;
        request->judge = [this, range](const RangeAnswer& head) {
            return judgeRangeAnswer(range, head, version_, name_);
        };
        request->ready = [this, id = request->id](Result<Bytes> result) {
            answer(id, result.ok() ? std::move(result) : Result<Bytes>(placed(result.error())));
        };
        open_.push_back({request, std::move(done)});
        link_->add(request);
        return request->id;
    }

    void cancel(RequestId id) override {
        auto at = find(id);
        if (at == open_.end())
            return;
        link_->takeBack(at->request);
        ++link_->readyToPump;
        answer(id, Error{ErrorCode::cancelled, "the request was taken back", name_, ""});
    }

    int pump(std::chrono::milliseconds) override {
        int delivered = 0;
        for (std::size_t left = ready_.size(); left > 0 && !ready_.empty(); --left, ++delivered) {
            auto [done, result] = std::move(ready_.front());
            ready_.pop_front();
            --link_->readyToPump;
            done(std::move(result));
        }
        return delivered;
    }

    bool forgetVersion() override {
        version_ = {};
        return true;
    }

    Progress progress(RequestId id) const override {
        for (const Open& one : open_)
            if (one.request->id == id)
                return link_->progress(*one.request);
        return {};
    }

    std::uint64_t sizeBytes() const override { return version_.sizeBytes; }
    std::string name() const override { return name_; }

  private:
    struct Open {
        std::shared_ptr<Link::Request> request;
        Completion done;
    };
    std::list<Open>::iterator find(RequestId id) {
        return std::find_if(open_.begin(), open_.end(),
                            [id](const Open& one) { return one.request->id == id; });
    }
    Error placed(Error error) const {
        if (error.where.empty())
            error.where = name_;
        return error;
    }
    void answer(RequestId id, Result<Bytes> result) {
        auto at = find(id);
        ready_.emplace_back(std::move(at->done), std::move(result));
        open_.erase(at);
    }

    std::shared_ptr<Link> link_;
    std::shared_ptr<const HostedFile> file_;
    std::string name_;
    FileVersion version_;
    std::list<Open> open_;
    std::deque<std::pair<Completion, Result<Bytes>>> ready_;
    RequestId last_ = 0;
};

SimulatedNetwork::SimulatedNetwork(const NetworkOptions& options) : link_(std::make_shared<Link>(options)) {}
SimulatedNetwork::~SimulatedNetwork() = default;

std::unique_ptr<ByteSource> SimulatedNetwork::open(std::shared_ptr<const HostedFile> file,
                                                   const std::string& name) {
    return std::make_unique<Source>(link_, std::move(file), name);
}

SimulatedNetwork::Time SimulatedNetwork::now() const {
    return link_->now;
}

bool SimulatedNetwork::advance(Duration most) {
    link_->fault = fault;
    Time until = link_->now + most;
    while (link_->readyToPump == 0 && link_->now < until)
        link_->step(until);
    return link_->readyToPump > 0;
}

const NetworkCounters& SimulatedNetwork::counters() const {
    return link_->counters;
}

} // namespace stipple::test
