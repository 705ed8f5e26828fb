// Answers that jobs make: sent as they come, bounded, fair between clients, and ended when nobody waits.
#include "server/http/problem.hpp"
#include "server/net/server.hpp"
#include "tests/http/support/raw_client.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace stipple;
using namespace stipple::server;
using namespace stipple::test;

namespace {

using Work = std::function<Status(AnswerWriter&)>;

Bytes bytesOf(std::string_view text) {
    return {text.begin(), text.end()};
}

HttpResponse textHead() {
    HttpResponse head;
    head.set("Content-Type", "text/plain");
    return head;
}

HttpResponse textAnswer(const std::string& text) {
    HttpResponse response = textHead();
    response.body.push_back(text);
    return response;
}

// A server every address of which ("/name") is a job; "/now" is none.
class JobServer {
  public:
    explicit JobServer(std::map<std::string, Work> jobs, ServerLimits limits = quickLimits()) {
        class Handler final : public RequestHandler {
          public:
            explicit Handler(std::map<std::string, Work> jobs) : jobs_(std::move(jobs)) {}
            Answer answer(const HttpRequest& request, std::int64_t) const override {
                auto found = jobs_.find(std::string(request.target.substr(1)));
                if (found != jobs_.end())
                    return Job{found->first, found->second};
                HttpResponse response = textAnswer("now");
                complete(request, response);
                return response;
            }
            void complete(const HttpRequest& request, HttpResponse& response) const override {
                response.set("X-Complete", "yes");
                response.sendsBody = request.method != "HEAD";
            }

          private:
            std::map<std::string, Work> jobs_;
        };
        ServerOptions options;
        options.limits = limits;
        options.threads = 2;
        auto started =
            Server::start(options, std::make_shared<Handler>(std::move(jobs)), [this](const auto& record) {
                std::lock_guard lock(mutex_);
                records_.push_back(record);
            });
        REQUIRE(started);
        server_ = std::move(*started);
    }

    static ServerLimits quickLimits() {
        ServerLimits limits;
        limits.sweep = std::chrono::milliseconds(20);
        limits.jobs.working = 1;
        return limits;
    }

    std::uint16_t port() const { return server_->port(); }
    Server& server() { return *server_; }
    std::vector<RequestRecord> logOf(std::size_t count) const {
        for (int i = 0; i < 1000; ++i) {
            {
                std::lock_guard lock(mutex_);
                if (records_.size() >= count)
                    return records_;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return {};
    }

  private:
    mutable std::mutex mutex_;
    std::vector<RequestRecord> records_;
    std::unique_ptr<Server> server_;
};

RawResponse ask(JobServer& server, const std::string& name) {
    return askOnce(server.port(), "GET /" + name + " HTTP/1.1\nHost: a");
}

std::string get(const std::string& name) {
    return "GET /" + name + " HTTP/1.1\r\nHost: a\r\n\r\n";
}

bool isTrueWithin(const std::function<bool()>& condition, int milliseconds = 5000) {
    for (int i = 0; i < milliseconds && !condition(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return condition();
}

// A job that goes on until it is stopped, and what a test sees of it.
struct Endless {
    std::atomic<int> running{0}, stopped{0};
    std::atomic<std::uint64_t> written{0};

    Work silent() { // never says anything
        return [this](AnswerWriter& writer) {
            ++running;
            while (!writer.isStopped())
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            ++stopped;
            return Status(Error{ErrorCode::cancelled, "stopped", "", ""});
        };
    }
    Work talking() {
        return [this](AnswerWriter& writer) {
            ++running;
            Status status = writer.begin(textHead());
            Bytes piece(100'000, 'x');
            while (status) {
                status = writer.write(piece);
                written += status ? piece.size() : 0;
            }
            ++stopped;
            return status;
        };
    }
};

Work writes(std::size_t pieces, std::size_t pieceBytes) {
    return [=](AnswerWriter& writer) -> Status {
        STIPPLE_CHECK(writer.begin(textHead()));
        for (std::size_t i = 0; i < pieces; ++i)
            STIPPLE_CHECK(writer.write(Bytes(pieceBytes, static_cast<std::uint8_t>('a' + i % 26))));
        return {};
    };
}

} // namespace

TEST_CASE("a job's answer has its length, its fields, and a line in the log") {
    JobServer server({{"text", [](AnswerWriter& writer) {
                           writer.answer(textAnswer("hello"));
                           return Status();
                       }}});
    RawClient client(server.port());
    auto response = client.ask("GET /text HTTP/1.1\nHost: a");
    CHECK(golden(response) == "HTTP/1.1 200 OK\nServer: stipple\nContent-Type: text/plain\n"
                              "X-Complete: yes\nContent-Length: 5\nConnection: keep-alive\n");
    CHECK(response.body == "hello");
    auto head = client.ask("HEAD /text HTTP/1.1\nHost: a");
    CHECK(golden(head) == golden(response));
    CHECK(client.ask("GET /now HTTP/1.1\nHost: a").body == "now");
    auto log = server.logOf(3);
    CHECK(log[0].job == "text");
    CHECK(log[0].bodyBytes == 5);
    CHECK(log[2].job == "");
}

TEST_CASE("a body of unknown length comes in chunks, and pipelined requests wait for its end") {
    JobServer server({{"stream", writes(30, 50'000)}, {"nothing", writes(0, 0)}, {"tiny", writes(1, 1)}});
    RawClient client(server.port());
    client.send(get("stream") + get("nothing") + get("tiny") + get("now"));
    auto response = client.receive();
    CHECK(golden(response) == "HTTP/1.1 200 OK\nServer: stipple\nContent-Type: text/plain\n"
                              "X-Complete: yes\nTransfer-Encoding: chunked\nConnection: keep-alive\n");
    REQUIRE(response.body.size() == 1'500'000);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < response.body.size(); ++i)
        wrong += response.body[i] != static_cast<char>('a' + i / 50'000 % 26);
    CHECK(wrong == 0);
    CHECK(response.isComplete);
    auto nothing = client.receive(), tiny = client.receive();
    CHECK(nothing.isComplete);
    CHECK(nothing.body.empty());
    CHECK(tiny.isComplete);
    CHECK(tiny.body == "a");
    CHECK(client.receive().body == "now");
    CHECK(server.logOf(4)[0].bodyBytes == 1'500'000);
}

TEST_CASE("one write may be larger than what may wait, and many small ones travel together") {
    JobServer server({{"large", writes(2, 3'000'000)}, {"small", writes(20'000, 50)}});
    auto large = ask(server, "large");
    CHECK(large.isComplete);
    CHECK(large.body == std::string(3'000'000, 'a') + std::string(3'000'000, 'b'));
    auto begin = std::chrono::steady_clock::now();
    auto small = ask(server, "small");
    auto glances = (std::chrono::steady_clock::now() - begin) / std::chrono::milliseconds(25);
    CHECK(small.isComplete);
    CHECK(small.body.size() == 1'000'000);
    // The first bytes, what is worth sending, and what is there every now and then.
    CHECK(small.chunks <= 1 + 1'000'000 / 16'384 + glances);
}

TEST_CASE("what a job has written reaches the client while it works on") {
    std::atomic<bool> mayEnd{false};
    JobServer server({{"slow", [&](AnswerWriter& writer) -> Status {
                           STIPPLE_CHECK(writer.begin(textHead()));
                           STIPPLE_CHECK(writer.write(bytesOf("first ")));
                           STIPPLE_CHECK(writer.write(bytesOf("second ")));
                           while (!mayEnd && !writer.isStopped())
                               std::this_thread::yield();
                           return writer.write(bytesOf("third"));
                       }}});
    RawClient client(server.port());
    client.send(get("slow"));
    CHECK(isTrueWithin([&] { return client.peek().find("second ") != std::string::npos; }));
    mayEnd = true;
    CHECK(client.receive().body == "first second third");
}

TEST_CASE("an HTTP/1.0 client gets bytes until the end, and a reset if there are too few") {
    JobServer server({{"stream", writes(30, 50'000)}, {"half", [](AnswerWriter& writer) -> Status {
                                                           STIPPLE_CHECK(writer.begin(textHead()));
                                                           STIPPLE_CHECK(writer.write(Bytes(50'000, 'x')));
                                                           return Error{ErrorCode::ioFailed, "broke", "", ""};
                                                       }}});
    auto whole = askOnce(server.port(), "GET /stream HTTP/1.0");
    CHECK(whole.field("connection") == "close");
    CHECK(whole.fields.count("transfer-encoding") == 0);
    CHECK(whole.body.size() == 1'500'000);
    CHECK(whole.isComplete);
    CHECK_FALSE(askOnce(server.port(), "GET /half HTTP/1.0").isComplete);
    CHECK_FALSE(ask(server, "half").isComplete);
    auto log = server.logOf(3);
    CHECK(log[0].isComplete);
    CHECK_FALSE(log[1].isComplete);
    CHECK_FALSE(log[2].isComplete);
}

TEST_CASE("HEAD of a streamed answer is its head, and ends the job") {
    Endless endless;
    JobServer server({{"talk", endless.talking()}});
    RawClient client(server.port());
    auto head = client.ask("HEAD /talk HTTP/1.1\nHost: a");
    CHECK(head.status == 200);
    CHECK(head.field("transfer-encoding") == "chunked");
    CHECK(client.ask("GET /now HTTP/1.1\nHost: a").body == "now"); // nothing of a body was in between
    CHECK(isTrueWithin([&] { return endless.stopped == 1; }));
    CHECK(endless.written == 0);
}

TEST_CASE("a job that fails before it answers is a problem document, by its code") {
    auto fails = [](ErrorCode code) -> Work {
        return [code](AnswerWriter&) { return Status(Error{code, "the reason", "/secret/path", ""}); };
    };
    JobServer server({{"io", fails(ErrorCode::ioFailed)},
                      {"none", fails(ErrorCode::notFound)},
                      {"bad", fails(ErrorCode::invalidArgument)},
                      {"changed", fails(ErrorCode::changed)},
                      {"silent", [](AnswerWriter&) { return Status(); }},
                      {"throws", [](AnswerWriter&) -> Status { throw std::runtime_error("thrown"); }}});
    RawClient client(server.port());
    for (auto [name, status] : {std::pair{"io", 500},
                                {"none", 404},
                                {"bad", 400},
                                {"changed", 503},
                                {"silent", 500},
                                {"throws", 500}}) {
        INFO(name);
        auto response = client.ask(std::string("GET /") + name + " HTTP/1.1\nHost: a");
        CHECK(response.status == status);
        CHECK(response.field("content-type") == "application/problem+json");
        CHECK(response.field("x-complete") == "yes");
        CHECK(response.body.find("/secret") == std::string::npos);
        CHECK(response.fields.count("retry-after") == (status == 503 ? 1 : 0));
    }
}

TEST_CASE("a job is held back by a client that does not read, and stopped when it leaves") {
    Endless endless;
    JobServer server({{"talk", endless.talking()}});
    auto client = std::make_unique<RawClient>(server.port());
    client->setReceiveBuffer(65536);
    client->send(get("talk"));
    REQUIRE(isTrueWithin([&] { return endless.written > 0; }));
    std::uint64_t last = 0;
    CHECK(isTrueWithin([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        return std::exchange(last, endless.written.load()) == endless.written;
    }));
    CHECK(last <= 8'000'000); // two half MiB here, the rest in the system's socket buffers
    auto begin = std::chrono::steady_clock::now();
    client.reset();
    CHECK(isTrueWithin([&] { return endless.stopped == 1; }));
    CHECK(std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(500));
    CHECK_FALSE(server.logOf(1)[0].isComplete);
}

TEST_CASE("a job that says nothing is stopped when its client leaves, also with pipelined requests behind") {
    Endless endless;
    JobServer server({{"silent", endless.silent()}});
    for (const std::string& behind : {std::string(), get("now")}) {
        int before = endless.stopped;
        auto client = std::make_unique<RawClient>(server.port());
        client->send(get("silent") + behind);
        REQUIRE(isTrueWithin([&] { return endless.running == before + 1; }));
        auto begin = std::chrono::steady_clock::now();
        client.reset();
        CHECK(isTrueWithin([&] { return endless.stopped == before + 1; }));
        CHECK(std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(500));
    }
    CHECK(server.logOf(2)[1].status == 499);
}

TEST_CASE("the job of a client that leaves while it waits never runs") {
    Endless endless;
    std::atomic<int> ran{0};
    JobServer server({{"silent", endless.silent()}, {"counts", [&](AnswerWriter& writer) {
                                                         ++ran;
                                                         writer.answer(textAnswer("ran"));
                                                         return Status();
                                                     }}});
    auto first = std::make_unique<RawClient>(server.port());
    first->send(get("silent"));
    REQUIRE(isTrueWithin([&] { return endless.running == 1; }));
    {
        RawClient waiting(server.port());
        waiting.send(get("counts"));
        CHECK(isTrueWithin([&] { return server.server().jobCounts().queued == 1; }));
    }
    CHECK(isTrueWithin([&] { return server.server().jobCounts().queued == 0; }));
    first.reset();
    CHECK(ask(server, "counts").body == "ran");
    CHECK(ran == 1);
    JobCounts counts = server.server().jobCounts();
    CHECK(counts.accepted == 3);
    CHECK(counts.cancelled == 2);
}

TEST_CASE("a job beyond its time is a 503 before it has begun, and cut after") {
    Endless endless;
    auto limits = JobServer::quickLimits();
    limits.jobs.work = std::chrono::milliseconds(200);
    JobServer server({{"silent", endless.silent()},
                      {"talk",
                       [&](AnswerWriter& writer) -> Status {
                           STIPPLE_CHECK(writer.begin(textHead()));
                           STIPPLE_CHECK(writer.write(bytesOf("begin")));
                           return endless.silent()(writer);
                       }}},
                     limits);
    RawClient client(server.port());
    auto late = client.ask("GET /silent HTTP/1.1\nHost: a");
    CHECK(late.status == 503);
    CHECK(late.body.find("0.2 seconds") != std::string::npos);
    auto cut = client.ask("GET /talk HTTP/1.1\nHost: a");
    CHECK(cut.status == 200);
    CHECK_FALSE(cut.isComplete);
    CHECK(isTrueWithin([&] { return endless.stopped == 2; }));
}

TEST_CASE("what waits too long for its turn is a 503") {
    Endless endless;
    auto limits = JobServer::quickLimits();
    limits.jobs.queue = std::chrono::milliseconds(100);
    JobServer server({{"silent", endless.silent()}}, limits);
    RawClient first(server.port());
    first.send(get("silent"));
    REQUIRE(isTrueWithin([&] { return endless.running == 1; }));
    auto second = ask(server, "silent");
    CHECK(second.status == 503);
    CHECK(second.field("retry-after") == "5");
}

TEST_CASE("a client with too many jobs gets 429, and everybody 503 when the queue is full") {
    Endless endless;
    auto limits = JobServer::quickLimits();
    limits.jobs.perClient = 3;
    limits.jobs.queued = 4;
    JobServer server({{"silent", endless.silent()}}, limits);
    std::vector<std::unique_ptr<RawClient>> clients;
    auto fill = [&](const char* from, int queued) {
        clients.push_back(std::make_unique<RawClient>(server.port(), from));
        clients.back()->send(get("silent"));
        return isTrueWithin([&] {
            JobCounts counts = server.server().jobCounts();
            return counts.running == 1 && counts.queued == queued;
        });
    };
    for (int i = 0; i < 3; ++i)
        REQUIRE(fill("127.0.0.1", i));
    auto busy = ask(server, "silent");
    CHECK(busy.status == 429);
    CHECK(busy.field("retry-after") == "1");
    CHECK(busy.field("content-type") == "application/problem+json");
    CHECK(busy.field("x-complete") == "yes");
    REQUIRE(fill("127.0.0.2", 3));
    REQUIRE(fill("127.0.0.3", 4));
    RawClient another(server.port(), "127.0.0.4");
    auto full = another.ask("GET /silent HTTP/1.1\nHost: a");
    CHECK(full.status == 503);
    CHECK(full.field("retry-after") == "5");
    CHECK(another.ask("GET /now HTTP/1.1\nHost: a").body == "now"); // what is no job goes on
    CHECK(server.server().jobCounts().refused == 2);
}

TEST_CASE("clients take turns, so that one who comes late waits for one job, not for all of another's") {
    Endless blocker;
    std::mutex mutex;
    std::string order;
    auto notes = [&](char who) -> Work {
        return [&, who](AnswerWriter& writer) {
            std::lock_guard lock(mutex);
            order += who;
            writer.answer(textAnswer("done"));
            return Status();
        };
    };
    JobServer server({{"block", blocker.silent()}, {"a", notes('a')}, {"b", notes('b')}, {"c", notes('c')}});
    auto first = std::make_unique<RawClient>(server.port());
    first->send(get("block"));
    REQUIRE(isTrueWithin([&] { return blocker.running == 1; }));
    std::vector<std::unique_ptr<RawClient>> clients;
    int queued = 0;
    auto queue = [&](const char* name, const char* from) {
        clients.push_back(std::make_unique<RawClient>(server.port(), from));
        clients.back()->send(get(name));
        ++queued;
        REQUIRE(isTrueWithin([&] { return server.server().jobCounts().queued == queued; }));
    };
    for (int i = 0; i < 5; ++i)
        queue("a", "127.0.0.2");
    queue("b", "127.0.0.3");
    queue("b", "127.0.0.3");
    queue("c", "127.0.0.4");
    first.reset();
    for (auto& client : clients)
        CHECK(client->receive().status == 200);
    CHECK(order == "abcabaaa");
}

TEST_CASE("one client never holds more than its share of what may run at once") {
    Endless endless;
    auto limits = JobServer::quickLimits();
    limits.jobs.working = 2;
    JobServer server({{"silent", endless.silent()},
                      {"quick",
                       [](AnswerWriter& writer) {
                           writer.answer(textAnswer("done"));
                           return Status();
                       }}},
                     limits);
    std::vector<std::unique_ptr<RawClient>> greedy;
    for (int i = 0; i < 4; ++i) {
        greedy.push_back(std::make_unique<RawClient>(server.port()));
        greedy.back()->send(get("silent"));
    }
    CHECK(isTrueWithin([&] {
        JobCounts counts = server.server().jobCounts();
        return counts.running == 1 && counts.queued == 3;
    }));
    CHECK(RawClient(server.port(), "127.0.0.2").ask("GET /quick HTTP/1.1\nHost: a").body == "done");
}

TEST_CASE("a client that reads slowly does not keep the jobs of others waiting") {
    Endless endless;
    JobServer server({{"talk", endless.talking()}, {"quick", [](AnswerWriter& writer) {
                                                        writer.answer(textAnswer("done"));
                                                        return Status();
                                                    }}});
    RawClient slow(server.port());
    slow.setReceiveBuffer(65536);
    slow.send(get("talk"));
    REQUIRE(isTrueWithin([&] { return endless.written > 0; }));
    CHECK(RawClient(server.port(), "127.0.0.2").ask("GET /quick HTTP/1.1\nHost: a").body == "done");
    CHECK(endless.stopped == 0);
}

TEST_CASE("stopping lets jobs finish, cutting stops them") {
    std::atomic<bool> mayEnd{false};
    Endless endless;
    JobServer server({{"waits",
                       [&](AnswerWriter& writer) -> Status {
                           STIPPLE_CHECK(writer.begin(textHead()));
                           while (!mayEnd && !writer.isStopped())
                               std::this_thread::yield();
                           return writer.write(bytesOf("the end"));
                       }},
                      {"silent", endless.silent()}},
                     [] {
                         auto limits = JobServer::quickLimits();
                         limits.jobs.working = 2;
                         return limits;
                     }());
    RawClient one(server.port()), two(server.port(), "127.0.0.2");
    one.send(get("waits"));
    two.send(get("silent"));
    REQUIRE(isTrueWithin([&] { return server.server().jobCounts().running == 2; }));
    server.server().stop();
    CHECK_FALSE(server.server().waitUntilDrained(std::chrono::milliseconds(100)));
    mayEnd = true;
    auto response = one.receive();
    CHECK(response.isComplete);
    CHECK(response.body == "the end");
    CHECK_FALSE(server.server().waitUntilDrained(std::chrono::milliseconds(100)));
    server.server().cut();
    CHECK(server.server().waitUntilDrained(std::chrono::milliseconds(5000)));
    CHECK(isTrueWithin([&] { return endless.stopped == 1; }));
}

TEST_CASE("a server that ends stops its jobs and waits for them") {
    Endless endless;
    {
        JobServer server({{"silent", endless.silent()}});
        RawClient one(server.port()), two(server.port(), "127.0.0.2");
        one.send(get("silent"));
        two.send(get("silent"));
        REQUIRE(isTrueWithin([&] { return endless.running == 1; }));
        REQUIRE(isTrueWithin([&] { return server.server().jobCounts().queued == 1; }));
    }
    CHECK(endless.running == 1);
    CHECK(endless.stopped == 1);
}
