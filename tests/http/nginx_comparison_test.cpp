// The golden cases, put to nginx on the same files: where its answers differ must be written down, with the
// reason, in nginx_differences.txt; what was found goes to nginx_differences.found in the build folder. Run
// by compare_with_nginx.sh, where nginx is.
#include "tests/http/support/golden_case.hpp"
#include "tests/http/support/raw_client.hpp"
#include "tests/http/support/test_server.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

extern char** environ;

using namespace stipple;
using namespace stipple::test;
namespace fs = std::filesystem;

namespace {

const fs::path testFolder = fs::path(STIPPLE_SOURCE_DIR) / "tests" / "http";

// A port that is free now.
std::uint16_t freePort() {
    TestServer server;
    return server.port();
}

class Nginx {
  public:
    Nginx(const TestFolder& folder, std::uint16_t port) {
        fs::path work = folder.path() / "nginx";
        fs::create_directories(work);
        std::string text = readFile(testFolder / "nginx.conf.in");
        std::map<std::string, std::string> values{{"@WORK@", work.string()},
                                                  {"@PORT@", std::to_string(port)},
                                                  {"@USER@", ::geteuid() == 0 ? "user root;" : ""},
                                                  {"@PAGE@", folder.page().string()},
                                                  {"@CLOUDS@", folder.clouds().string()}};
        for (const auto& [name, value] : values)
            for (std::size_t at; (at = text.find(name)) != std::string::npos;)
                text.replace(at, name.size(), value);
        std::string config = (work / "nginx.conf").string(), prefix = work.string(), program = "nginx",
                    c = "-c", p = "-p";
        std::ofstream(config) << text;
        char* arguments[] = {program.data(), c.data(), config.data(), p.data(), prefix.data(), nullptr};
        REQUIRE(::posix_spawnp(&child_, "nginx", nullptr, nullptr, arguments, environ) == 0);
        for (int i = 0; i < 500 && !RawClient(port).isConnected(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    ~Nginx() {
        ::kill(child_, SIGTERM);
        ::waitpid(child_, nullptr, 0);
    }

  private:
    pid_t child_ = 0;
};

struct Played {
    int status = 0;
    std::map<std::string, std::string> fields;
    std::string body;
};
struct PlayedCase {
    std::vector<std::string> requests; // first line and fields, short
    std::vector<Played> responses;
};

PlayedCase parsePlayed(const std::string& text) {
    PlayedCase played;
    std::istringstream lines(text);
    bool isRequestStart = true;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("> ")) {
            std::string part = line.substr(2);
            if (isRequestStart)
                played.requests.push_back(part.substr(0, part.find(" HTTP/")));
            else if (part != "Host: localhost")
                played.requests.back() += "; " + part.substr(0, 60);
            isRequestStart = false;
        } else if (line == ">") {
            isRequestStart = true;
        } else if (line.starts_with("< HTTP/")) {
            played.responses.push_back({std::atoi(line.c_str() + 11), {}, ""});
        } else if (line.starts_with("< ")) {
            std::size_t colon = line.find(": ");
            played.responses.back().fields[line.substr(2, colon - 2)] = line.substr(colon + 2);
        } else if (line.starts_with("|") && !played.responses.empty()) {
            played.responses.back().body += line.substr(std::min<std::size_t>(2, line.size())) + "\n";
        }
    }
    return played;
}

// What of two answers differs that does not depend on how nginx is configured. Not Vary and Accept-Ranges:
// nginx has the one only beside a coded file, the other only with a 200 of a plain one.
std::vector<std::string> differences(const Played& ours, const Played& theirs) {
    if (ours.status != theirs.status)
        return {std::to_string(ours.status) + ", nginx " + std::to_string(theirs.status)};
    std::vector<std::string> found;
    if (ours.status >= 400)
        return found; // pages of errors are each server's own
    auto value = [](const Played& played, const std::string& name) {
        auto field = played.fields.find(name);
        return field == played.fields.end() ? std::string("none") : field->second;
    };
    for (const char* name :
         {"Content-Length", "Content-Range", "Content-Encoding", "Last-Modified", "ETag", "Connection"})
        if (value(ours, name) != value(theirs, name))
            found.push_back(std::string(name) + " " + value(ours, name) + ", nginx " + value(theirs, name));
    if (ours.body != theirs.body && value(ours, "Content-Type").find("boundary") == std::string::npos)
        found.push_back("another body");
    return found;
}

std::string compareCase(const std::string& name, const PlayedCase& ours, const PlayedCase& theirs) {
    std::string text;
    for (std::size_t i = 0; i < ours.requests.size(); ++i) {
        std::string where = name + " | " + ours.requests[i] + " | ";
        bool weAnswer = i < ours.responses.size(), theyAnswer = i < theirs.responses.size();
        if (weAnswer != theyAnswer)
            text += where + (weAnswer ? "answered, nginx closed" : "closed, nginx answered") + "\n";
        if (weAnswer && theyAnswer)
            for (const std::string& difference : differences(ours.responses[i], theirs.responses[i]))
                text += where + difference + "\n";
    }
    return text;
}

GoldenNames namesOf(std::uint16_t port) {
    return [port](const std::string& name) {
        std::size_t space = name.find(' ', 5);
        std::string coding = space == std::string::npos ? "" : "\nAccept-Encoding: " + name.substr(space + 1);
        return askOnce(port, "HEAD " + name.substr(5, space - 5) + " HTTP/1.1\nHost: localhost" + coding)
            .field("etag");
    };
}

// The lines of the file without comments and empty ones.
std::string knownDifferences() {
    std::istringstream lines(readFile(testFolder / "nginx_differences.txt"));
    std::string text;
    for (std::string line; std::getline(lines, line);)
        if (!line.empty() && !line.starts_with("#"))
            text += line + "\n";
    return text;
}

} // namespace

TEST_CASE("nginx answers the golden cases as this server does, but for known differences", "[.nginx]") {
    TestServer server;
    std::uint16_t port = freePort();
    Nginx nginx(server.folder(), port);
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(testFolder / "golden" / "open"))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::string found;
    for (const fs::path& file : files) {
        std::string text = readFile(file), name = file.stem().string();
        if (text.find(" /api/") != std::string::npos || name == "preflight" || name == "cors_every_status")
            continue; // what nginx has not
        if (name == "range_malformed_large")
            continue; // nginx would send 5 GB
        found +=
            compareCase(name, parsePlayed(playGoldenCase(text, server.port(), namesOf(server.port()), true)),
                        parsePlayed(playGoldenCase(text, port, namesOf(port), true)));
    }
    std::ofstream(fs::path(STIPPLE_TEST_OUTPUT) / "nginx_differences.found") << found;
    CHECK(found == knownDifferences());
}
