#include "server/upstream/upstream_tokens.hpp"

#include "server/upstream/upstream.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

using namespace stipple;
using namespace stipple::server;
using namespace stipple::test;

TEST_CASE("each origin has its token, whatever the case and with or without its usual port") {
    auto tokens = UpstreamTokens::parse("# ours\n\nhttps://Bucket.example  abc.DEF-1~2_3+/4==\r\n"
                                        "http://10.0.0.7:8017\tother # the forest\n");
    REQUIRE(tokens.ok());
    CHECK(tokens->of("https://bucket.example:443") == "abc.DEF-1~2_3+/4==");
    CHECK(tokens->of("http://10.0.0.7:8017") == "other");
    CHECK(tokens->of("http://bucket.example:80").empty());
    CHECK(tokens->of("https://bucket.example:444").empty());
    CHECK(tokens->of("https://bucket.example.evil:443").empty());
    CHECK(UpstreamTokens().of("https://bucket.example:443").empty());
}

TEST_CASE("lines that are not an origin and a token are refused by their number, without what they hold") {
    for (const char* line :
         {"secret", "https://a", "https://a/ secret", "https://a/b secret", "ftp://a secret",
          "https://a secret more", "https://a sec\"ret", "https://a =", "https://a s\x01"}) {
        INFO(line);
        auto tokens = UpstreamTokens::parse(std::string("\n") + line);
        REQUIRE_FALSE(tokens.ok());
        CHECK(tokens.error().where == "line 2");
        CHECK(tokens.error().sentence().find("secret") == std::string::npos);
    }
    CHECK(UpstreamTokens::parse("https://a x\nhttps://A:443 y").error().where == "line 2");
}

TEST_CASE("a file of tokens that everybody can read is refused") {
    TemporaryFolder folder;
    std::string path = folder.file("tokens");
    std::ofstream(path) << "https://a x\n";
    namespace fs = std::filesystem;
    fs::permissions(path, fs::perms::owner_read | fs::perms::others_read);
    auto refused = UpstreamTokens::load(path);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().advice == "chmod o= on it");
    fs::permissions(path, fs::perms::owner_read);
    auto loaded = UpstreamTokens::load(path);
    REQUIRE(loaded.ok());
    CHECK(loaded->of("https://a:443") == "x");
    CHECK(UpstreamTokens::load(folder.file("absent")).error().code == ErrorCode::notFound);
}

TEST_CASE("a file of tokens that is read again replaces them, unless it can't be used") {
    TemporaryFolder folder;
    std::string path = folder.file("tokens");
    auto write = [&](const char* text) {
        std::ofstream(path) << text;
        std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    };
    write("https://a x\n");
    UpstreamOptions options;
    options.tokenPath = path;
    auto upstream = Upstream::open(options);
    REQUIRE(upstream.ok());
    CHECK((*upstream)->tokenFor("https://a:443") == "x");
    write("https://a y\nhttps://b z\n");
    CHECK((*upstream)->reloadTokens().ok());
    CHECK((*upstream)->tokenFor("https://a:443") == "y");
    CHECK((*upstream)->tokenFor("https://b:443") == "z");
    write("https://a\n");
    CHECK_FALSE((*upstream)->reloadTokens().ok());
    CHECK((*upstream)->tokenFor("https://a:443") == "y");
    CHECK_FALSE(Upstream::open(options).ok());
}
