// Every kind of answer, field by field, against the files in tests/http/golden: those of `open` by a server
// whose clouds are public, those of `private` by one that has private ones and lists an origin.
//
// STIPPLE_UPDATE_GOLDEN=1 writes what the server answers into the files. Such a run never passes.
#include "server/access/signed_address.hpp"
#include "server/access/token.hpp"
#include "tests/http/support/golden_case.hpp"
#include "tests/http/support/raw_client.hpp"
#include "tests/http/support/test_server.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>

using namespace stipple;
using namespace stipple::test;
namespace fs = std::filesystem;

namespace {

const fs::path goldenFolder = fs::path(STIPPLE_SOURCE_DIR) / "tests" / "http" / "golden";

std::vector<fs::path> casesOf(const char* folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(goldenFolder / folder))
        if (entry.path().extension() == ".txt")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

void playAll(const char* folder, TestServer& server, const std::map<std::string, std::string>& names) {
    auto nameValue = [&](const std::string& name) {
        auto known = names.find(name);
        if (known != names.end())
            return known->second;
        if (name.starts_with("etag ")) // of an address, perhaps in a coding: "etag /app.js br"
        {
            std::size_t space = name.find(' ', 5);
            std::string coding =
                space == std::string::npos ? "" : "\nAccept-Encoding: " + name.substr(space + 1);
            return askOnce(server.port(),
                           "HEAD " + name.substr(5, space - 5) + " HTTP/1.1\nHost: localhost" + coding)
                .field("etag");
        }
        FAIL("no value for {" << name << "}");
        return std::string();
    };
    std::vector<fs::path> files = casesOf(folder);
    REQUIRE_FALSE(files.empty());
    for (const fs::path& file : files) {
        INFO(file.filename().string());
        std::string expected = readFile(file);
        std::string actual = playGoldenCase(expected, server.port(), nameValue);
        CHECK(actual == expected);
        if (std::getenv("STIPPLE_UPDATE_GOLDEN") != nullptr)
            std::ofstream(file) << actual;
    }
    CHECK(std::getenv("STIPPLE_UPDATE_GOLDEN") == nullptr); // an updating run never passes
}

} // namespace

TEST_CASE("answers about public things read as their golden files say") {
    TestServer server;
    playAll("open", server, {});
}

TEST_CASE("answers about private clouds read as their golden files say") {
    std::map<std::string, std::string> names;
    TestServer server(TestServer::quickLimits(), [&](TestFolder& folder) {
        writeCloud((folder.clouds() / "plant.stipple").string(), 10, 3);
        setChangedTime(folder.clouds() / "plant.stipple", TestFolder::changedSeconds);
        auto rules = server::freshAccessRules().value();
        rules.privateClouds = {"plant", "mine-*"};
        auto add = [&](const char* name, const char* cloud, std::int64_t expires) {
            auto token = server::makeToken(rules, name, {cloud}, 1, expires).value();
            rules.tokens.push_back(token.rule);
            names[name] = token.text;
        };
        add("token", "plant", 0);
        add("token for mine-1", "mine-1", 0);
        add("expired token", "plant", 2);
        names["signed"] = server::signedQuery(rules.signingKey, "plant", std::time(nullptr) + 1000);
        names["expired"] = server::signedQuery(rules.signingKey, "plant", 2);
        std::string file = (folder.path() / "access.json").string();
        if (Status status = server::writeAccessFile(file, rules); !status)
            FAIL(status.error().sentence());
        server::SiteOptions options;
        options.access = std::move(server::AccessControl::open(file).value());
        options.cors = server::CorsRules::listing({"https://maps.example"}).value();
        return options;
    });
    playAll("private", server, names);
}
