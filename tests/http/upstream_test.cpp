// A server before another one (stipple serve http://…): the same bytes, few requests to the other, never
// bytes of two versions, and clear answers while the other is away.
#include "client/headless/http_source.hpp"
#include "client/headless/tls_trust.hpp"
#include "server/access/token.hpp"
#include "tests/http/support/listener.hpp"
#include "tests/http/support/raw_client.hpp"
#include "tests/http/support/scripted_http_server.hpp"
#include "tests/http/support/test_server.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

using namespace stipple;
using namespace stipple::test;
namespace fs = std::filesystem;
using namespace std::chrono_literals;

namespace {

const std::string target = "/clouds/town.stipple";

template <class T>
T need(Result<T> result) {
    if (!result.ok())
        FAIL(result.error().sentence());
    return std::move(result).value();
}

std::unique_ptr<server::Server> serve(const std::vector<std::string>& paths, std::uint16_t port = 0,
                                      const server::UpstreamOptions& upstream = {}) {
    auto catalog = need(server::CloudCatalog::open(paths, {}, upstream));
    auto page = need(server::openPageFolder(""));
    auto site =
        std::make_shared<const server::Site>(std::move(catalog.catalog), server::Page(std::move(page)));
    server::ServerOptions options;
    options.threads = 2;
    options.port = port;
    options.limits = TestServer::quickLimits();
    options.metrics = server::MetricsFor::everyone;
    return need(server::Server::start(options, site, {}));
}

// Looks at its upstream for each request that comes after 20 ms.
server::UpstreamOptions quick() {
    server::UpstreamOptions options;
    options.freshFor = 20ms;
    options.retryPause = 50ms;
    options.connectTimeout = options.answerTimeout = 2000ms;
    return options;
}

RawResponse ask(const server::Server& server, const std::string& line, const std::string& fields = "") {
    return askOnce(server.port(), line + " HTTP/1.1\nHost: a" + (fields.empty() ? "" : "\n" + fields));
}

std::string problemOf(const RawResponse& response) {
    CHECK(response.field("content-type") == "application/problem+json");
    std::string type = nlohmann::json::parse(response.body).at("type");
    return type.substr(type.rfind('/') + 1);
}

double metric(const server::Server& server, const std::string& name) {
    std::string text = "\n" + ask(server, "GET /metrics").body;
    auto at = text.find("\n" + name + " ");
    REQUIRE(at != std::string::npos);
    return std::stod(text.substr(at + name.size() + 2));
}

// Accepts and says nothing.
class SilentServer {
  public:
    std::string url() const { return listener_.origin() + "/town.stipple"; }

  private:
    Listener listener_;
};

void replace(const fs::path& cloud, const fs::path& with) {
    fs::path fresh = cloud.string() + ".new";
    fs::copy_file(with, fresh, fs::copy_options::overwrite_existing);
    fs::rename(fresh, cloud);
}

} // namespace

TEST_CASE("a front answers every kind of range with its upstream's bytes, and asks for each block once") {
    TestServer upstream;
    writeCloud(upstream.folder().cloud().string(), 400'000, 3);
    std::string file = readFile(upstream.folder().cloud());
    REQUIRE(file.size() > 3 * 256 * 1024);
    server::UpstreamOptions options;
    options.freshFor = 1h;
    auto front = serve({upstream.url(target)}, 0, options);

    auto whole = ask(*front, "GET " + target);
    CHECK(whole.status == 200);
    CHECK(whole.isComplete);
    CHECK(whole.field("content-length") == std::to_string(file.size()));
    CHECK(whole.body == file);
    std::string tag = whole.field("etag");
    CHECK(tag.starts_with('"'));

    std::string middle = std::to_string(file.size() / 2), last = std::to_string(file.size() - 1);
    const std::vector<std::string> ranges{"0-0",        "1000-300000", "-5000",
                                          middle + "-", "0-" + last,   "100-199,300000-300099,-10"};
    for (const std::string& range : ranges) {
        auto ours = ask(*front, "GET " + target, "Range: bytes=" + range);
        auto theirs = ask(upstream.server(), "GET " + target, "Range: bytes=" + range);
        CHECK(ours.status == 206);
        CHECK(ours.field("content-range") == theirs.field("content-range"));
        CHECK(ours.field("content-length") == theirs.field("content-length"));
        if (range.find(',') == std::string::npos)
            CHECK(ours.body == theirs.body);
        else
            CHECK(ours.body.find(file.substr(300000, 100)) != std::string::npos);
    }
    CHECK(ask(*front, "GET " + target, "Range: bytes=99999999-").status == 416);
    CHECK(ask(*front, "GET " + target, "If-None-Match: " + tag).status == 304);
    CHECK(ask(*front, "GET " + target, "If-Match: \"x\"").status == 412);
    RawClient head(front->port());
    REQUIRE(head.send("HEAD " + target + " HTTP/1.1\r\nHost: a\r\n\r\n"));
    CHECK(head.receive(false).field("content-length") == std::to_string(file.size()));
    CHECK(head.ask("GET " + target + " HTTP/1.1\nHost: a\nRange: bytes=7-16").body == file.substr(7, 10));

    std::size_t records = upstream.logOf(1).size();
    std::uint64_t blocks = (file.size() + 262143) / 262144, bytes = 0;
    for (const auto& record : upstream.log())
        bytes += record.userAgent == "stipple" ? record.bodyBytes : 0;
    CHECK(bytes <= file.size() + 128 + blocks); // each byte once, and the header that was looked at first
    CHECK(records > 0);
    CHECK(metric(*front, "stipple_cache_misses_total{cache=\"upstream\"}") == static_cast<double>(blocks));
}

TEST_CASE("clients that want the same bytes at once cost the upstream one request for each block") {
    TestServer upstream;
    writeCloud(upstream.folder().cloud().string(), 400'000, 3);
    std::string file = readFile(upstream.folder().cloud());
    auto front = serve({upstream.url(target)});
    std::vector<std::thread> clients;
    std::atomic<int> right{0};
    for (int i = 0; i < 24; ++i)
        clients.emplace_back([&] { right += ask(*front, "GET " + target).body == file; });
    for (std::thread& client : clients)
        client.join();
    CHECK(right == 24);
    double blocks = static_cast<double>((file.size() + 262143) / 262144);
    CHECK(metric(*front, "stipple_cache_misses_total{cache=\"upstream\"}") == blocks);
    CHECK(metric(*front, "stipple_upstream_requests_total") <= blocks + 1);
}

TEST_CASE("the API of a front says what its upstream's says") {
    TestServer upstream;
    auto front = serve({upstream.url(target)});
    for (const char* address :
         {"/hierarchy/0-0-0-0", "/nodes/0-0-0-0", "/nodes/0-0-0-0?format=csv", "/points?format=csv"}) {
        std::string path = std::string("GET /api/v1/clouds/town") + address;
        auto ours = ask(*front, path), theirs = ask(upstream.server(), path);
        INFO(address << " " << ours.body.substr(0, 200));
        REQUIRE(theirs.status == 200);
        CHECK(ours.status == 200);
        if (std::string(address).find("hierarchy") == std::string::npos)
            CHECK(ours.body == theirs.body);
    }
    auto list = nlohmann::json::parse(ask(*front, "GET /api/v1/clouds").body);
    REQUIRE(list["clouds"].size() == 1);
    CHECK(list["clouds"][0]["id"] == "town");
    CHECK(list["clouds"][0]["pointCount"] == 20'000);
}

TEST_CASE(
    "a cloud that is replaced upstream: old tags get 412, others the new one, downloads are never mixed") {
    TestServer upstream;
    fs::path a = upstream.folder().path() / "a", b = upstream.folder().path() / "b";
    writeCloud(a.string(), 400'000, 1);
    writeCloud(b.string(), 400'000, 2);
    std::string bytes[2] = {readFile(a), readFile(b)};
    replace(upstream.folder().cloud(), a);
    auto front = serve({upstream.url(target)}, 0, quick());
    auto old = ask(*front, "GET " + target);
    REQUIRE(old.body == bytes[0]);

    replace(upstream.folder().cloud(), b);
    std::this_thread::sleep_for(50ms);
    std::string range = "\nRange: bytes=600000-600009";
    auto refused = ask(*front, "GET " + target, "If-Match: " + old.field("etag") + range);
    CHECK(refused.status == 412);
    CHECK(refused.field("etag") != old.field("etag"));
    CHECK(ask(*front, "GET " + target, "If-Range: " + old.field("etag") + range).body == bytes[1]);
    CHECK(ask(*front, "GET " + target, range.substr(1)).body == bytes[1].substr(600000, 10));
    CHECK(metric(*front, "stipple_upstream_changes_total") == 1);

    std::atomic<bool> isOver{false};
    std::atomic<int> ofOne{0}, cut{0}, refusals{0}, mixed{0};
    std::vector<std::thread> clients;
    for (int i = 0; i < 4; ++i)
        clients.emplace_back([&] {
            while (!isOver) {
                auto answer = ask(*front, "GET " + target);
                if (answer.status != 200)
                    ++refusals;
                else if (answer.isComplete)
                    ++(answer.body == bytes[0] || answer.body == bytes[1] ? ofOne : mixed);
                else
                    ++(bytes[0].starts_with(answer.body) || bytes[1].starts_with(answer.body) ? cut : mixed);
            }
        });
    // Often at first; then more seldom, until a download was quicker than that on this machine.
    auto pause = 40ms;
    for (int i = 0; i < 30 || (ofOne == 0 && pause < 10s); ++i) {
        replace(upstream.folder().cloud(), i % 2 ? b : a);
        std::this_thread::sleep_for(pause);
        pause = i < 30 ? pause : 2 * pause;
    }
    isOver = true;
    for (std::thread& client : clients)
        client.join();
    INFO(ofOne << " whole, " << cut << " cut, " << refusals << " refused");
    CHECK(mixed == 0);
    CHECK(ofOne > 0);
    CHECK(metric(*front, "stipple_upstream_changes_total") > 3);
}

TEST_CASE("while the upstream is away: held bytes are answered, others get 502 and when to come again") {
    TestFolder folder;
    writeCloud(folder.cloud().string(), 400'000, 1);
    std::string file = readFile(folder.cloud());
    auto upstream = serve({folder.clouds().string()});
    std::uint16_t port = upstream->port();
    std::string url = upstream->address() + target.substr(1);
    auto front = serve({url}, 0, quick());
    auto early = serve({url}, 0, quick()), late = serve({url}, 0, quick());
    std::string held = "Range: bytes=100-199", notHeld = "Range: bytes=300000-300099";
    REQUIRE(ask(*front, "GET " + target, held).body == file.substr(100, 100));

    upstream.reset();
    std::this_thread::sleep_for(50ms);
    CHECK(ask(*front, "GET " + target, held).body == file.substr(100, 100));
    for (const auto& away : {ask(*front, "GET " + target, notHeld), ask(*late, "GET " + target, held),
                             ask(*late, "GET /api/v1/clouds/town")}) {
        CHECK(away.status == 502);
        CHECK(away.field("retry-after") == "5");
        CHECK(problemOf(away) == "upstream-failed");
        CHECK(away.body.find("127.0.0.1") == std::string::npos); // addresses may hold signatures
    }
    CHECK(ask(*late, "GET /api/v1/clouds").body == "{\"clouds\":[]}\n");
    CHECK(metric(*front, "stipple_upstream_failures_total") > 0);

    upstream = serve({folder.clouds().string()}, port);
    std::this_thread::sleep_for(100ms);
    CHECK(ask(*front, "GET " + target, notHeld).body == file.substr(300000, 100));
    CHECK(ask(*late, "GET " + target, held).body == file.substr(100, 100));
    CHECK(ask(*early, "GET " + target).body == file);
}

TEST_CASE("an upstream that does not answer is a 504, one without the file a 404, one that is none a 503") {
    SilentServer silent;
    auto options = quick();
    options.answerTimeout = 200ms;
    auto front = serve({silent.url()}, 0, options);
    auto late = ask(*front, "GET " + target);
    CHECK(late.status == 504);
    CHECK(late.field("retry-after") == "5");
    CHECK(problemOf(late) == "upstream-timed-out");
    CHECK(metric(*front, "stipple_upstream_timeouts_total") >= 1);

    TestServer upstream;
    auto absent = serve({upstream.url("/clouds/none.stipple")}, 0, quick());
    CHECK(ask(*absent, "GET /clouds/none.stipple").status == 404);
    auto other = serve({upstream.url("/pattern.bin")}, 0, quick());
    auto noCloud = ask(*other, "GET /clouds/pattern.stipple");
    CHECK(noCloud.status == 503);
    CHECK(problemOf(noCloud) == "cloud-unusable");
    CHECK(server::CloudCatalog::open({"ftp://host/x.stipple"}).error().code == ErrorCode::unsupported);
    CHECK(server::CloudCatalog::open({"http://host:0/x.stipple"}).error().code == ErrorCode::invalidArgument);
}

TEST_CASE("an upstream that wants a token gets the one in the file, and nobody else sees it") {
    std::string token;
    TestServer upstream(TestServer::quickLimits(), [&](TestFolder& folder) {
        auto rules = need(server::freshAccessRules());
        rules.privateClouds = {"town"};
        auto made = need(server::makeToken(rules, "front", {"town"}, 1, 0));
        token = made.text;
        rules.tokens.push_back(made.rule);
        std::string file = (folder.path() / "access.json").string();
        REQUIRE(server::writeAccessFile(file, rules).ok());
        server::SiteOptions options;
        options.access = need(server::AccessControl::open(file));
        return options;
    });
    auto without = serve({upstream.url(target)}, 0, quick());
    CHECK(ask(*without, "GET " + target).status == 502);

    // Through a server that redirects, which must not learn the token.
    ScriptedHttpServer first([&](const std::string&) { return redirectTo(upstream.url(target)); });
    fs::path file = upstream.folder().path() / "tokens";
    std::string origin = upstream.url("/");
    origin.pop_back();
    std::ofstream(file) << origin << " " << token << "\n";
    fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
    auto options = quick();
    options.tokenPath = file.string();
    for (const std::string& url : {upstream.url(target), first.origin() + target}) {
        auto front = serve({url}, 0, options);
        auto answer = ask(*front, "GET " + target);
        CHECK(answer.status == 200);
        CHECK(answer.body == readFile(upstream.folder().cloud()));
        CHECK(ask(*front, "GET /metrics").body.find(token) == std::string::npos);
    }
    CHECK(first.requests().size() > 0);
    for (const std::string& request : first.requests())
        CHECK(request.find(token) == std::string::npos);

    std::ofstream(file) << origin << "\n";
    auto broken = server::CloudCatalog::open({upstream.url(target)}, {}, options);
    REQUIRE_FALSE(broken.ok());
    CHECK(broken.error().where == file.string() + ", line 1");
}

TEST_CASE("blocks on disk outlive the front: another one asks the upstream for none of them again") {
    TestServer upstream;
    writeCloud(upstream.folder().cloud().string(), 400'000, 3);
    std::string bytes = readFile(upstream.folder().cloud());
    server::UpstreamOptions options;
    options.freshFor = 1h;
    options.diskFolder = (upstream.folder().path() / "blocks").string();
    double asked[2];
    for (int round = 0; round < 2; ++round) {
        auto front = serve({upstream.url(target)}, 0, options);
        auto answer = ask(*front, "GET " + target);
        CHECK(answer.body == bytes);
        asked[round] = metric(*front, "stipple_upstream_bytes_total");
    }
    CHECK(asked[0] >= static_cast<double>(bytes.size()));
    CHECK(asked[1] < 1000); // the header, to see which version it is

    // Every block damaged: all are dropped and asked for again.
    for (const auto& entry : fs::recursive_directory_iterator(options.diskFolder))
        if (entry.path().extension() == ".block") {
            std::fstream file(entry.path(), std::ios::in | std::ios::out | std::ios::binary);
            file.seekg(-1, std::ios::end);
            char last = static_cast<char>(file.get() ^ 1);
            file.seekp(-1, std::ios::end);
            file.put(last);
        }
    auto front = serve({upstream.url(target)}, 0, options);
    CHECK(ask(*front, "GET " + target).body == bytes);
    CHECK(metric(*front, "stipple_upstream_disk_damaged_total") >= 3);
    CHECK(metric(*front, "stipple_upstream_bytes_total") >= static_cast<double>(bytes.size()));
    front.reset();

    // Another version has blocks of its own.
    writeCloud(upstream.folder().cloud().string() + ".new", 400'000, 4);
    fs::rename(upstream.folder().cloud().string() + ".new", upstream.folder().cloud());
    front = serve({upstream.url(target)}, 0, options);
    CHECK(ask(*front, "GET " + target).body == readFile(upstream.folder().cloud()));
}

TEST_CASE("https: a certificate that rests on a trusted one is believed, any other is not") {
    TestServer upstream(TestServer::Https{});
    std::string file = readFile(upstream.folder().cloud());
    auto options = quick();
    options.caPath = upstream.certificate().certificatePath; // it signed itself
    auto front = serve({upstream.url(target)}, 0, options);
    CHECK(ask(*front, "GET " + target).body == file);

    auto doubting = serve({upstream.url(target)}, 0, quick());
    auto refused = ask(*doubting, "GET " + target);
    CHECK(refused.status == 502);
    CHECK(refused.body.find("not trusted") != std::string::npos);

    TestCertificate other = makeCertificate(upstream.folder().path(), "other");
    options.caPath = other.certificatePath;
    auto wrong = serve({upstream.url(target)}, 0, options);
    CHECK(ask(*wrong, "GET " + target).status == 502);

    // The right certificate, but not for this name.
    HttpSourceOptions direct;
    direct.trust = need(TlsTrust::load(upstream.certificate().certificatePath));
    CHECK(readNow(*need(openHttpSource(upstream.url(target), direct)), {0, 10}).ok());
    std::string elsewhere = "https://127.0.0.2:" + std::to_string(upstream.port()) + target;
    CHECK_FALSE(readNow(*need(openHttpSource(elsewhere, direct)), {0, 10}).ok());
    std::string plain = "https://127.0.0.1:" + std::to_string(TestServer().port()) + target;
    CHECK_FALSE(readNow(*need(openHttpSource(plain, direct)), {0, 10}).ok());

    CHECK(TlsTrust::load("/nonexistent.pem").error().code == ErrorCode::notFound);
    CHECK(TlsTrust::load(upstream.folder().cloud().string()).error().code == ErrorCode::invalidArgument);
}

TEST_CASE("a client that leaves in the middle of a download from upstream leaves nothing behind") {
    TestServer upstream;
    writeCloud(upstream.folder().cloud().string(), 400'000, 3);
    auto front = serve({upstream.url(target)});
    for (int i = 0; i < 20; ++i) {
        RawClient left(front->port());
        left.setReceiveBuffer(4096);
        left.send("GET " + target + " HTTP/1.1\r\nHost: a\r\n\r\n");
        if (i % 2)
            std::this_thread::sleep_for(10ms);
    }
    auto until = std::chrono::steady_clock::now() + 5s;
    while (metric(*front, "stipple_transfers_running") > 0 && std::chrono::steady_clock::now() < until)
        std::this_thread::sleep_for(20ms);
    CHECK(metric(*front, "stipple_transfers_running") == 0);
    CHECK(ask(*front, "GET " + target).body == readFile(upstream.folder().cloud()));
}
