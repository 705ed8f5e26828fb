#include "tests/http/support/golden_case.hpp"

#include "tests/http/support/raw_client.hpp"

#include <algorithm>
#include <memory>
#include <sstream>
#include <vector>

namespace stipple::test {

namespace {

constexpr std::size_t shownBodyBytes = 1500;

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

std::string repeated(const std::string& arguments) { // "N TEXT"
    std::size_t space = arguments.find(' ');
    std::string text;
    for (int i = std::stoi(arguments); i > 0; --i)
        text += arguments.substr(space + 1);
    return text;
}

std::string replaced(const std::string& line, const GoldenNames& names) {
    std::string text;
    for (std::size_t i = 0; i < line.size(); ++i) {
        std::size_t end = line.find('}', i);
        if (line.compare(i, 2, "\\x") == 0 && i + 3 < line.size()) {
            text += static_cast<char>(std::stoi(line.substr(i + 2, 2), nullptr, 16));
            i += 3;
        } else if (line[i] == '{' && end != std::string::npos) {
            std::string name = line.substr(i + 1, end - i - 1);
            text += name.starts_with("repeat ") ? repeated(name.substr(7)) : names(name);
            i = end;
        } else {
            text += line[i];
        }
    }
    return text;
}

// Tags are made of inodes, whose numbers have more or fewer digits.
bool hasTags(const RawResponse& response) {
    return response.body.find("\"etag\":") != std::string::npos;
}

std::string headLines(const RawResponse& response) {
    std::string text;
    for (std::string line : linesOf(response.head)) {
        if (!line.empty() && line.back() == '\r')
            line.pop_back();
        for (const char* name : {"Date: ", "ETag: ", hasTags(response) ? "Content-Length: " : "Date: "})
            if (line.starts_with(name))
                line = std::string(name) + "...";
        if (std::size_t at = line.find("boundary="); at != std::string::npos)
            line = line.substr(0, at) + "boundary=...";
        text += "< " + line + "\n";
    }
    return text + "<\n";
}

// The boundary is replaced in the body as in the head.
std::string bodyLines(const RawResponse& response) {
    std::string body = response.body, type = response.field("content-type");
    if (body.empty())
        return "";
    if (hasTags(response))
        return "| (JSON with tags)\n";
    bool isText = body.size() <= shownBodyBytes && std::all_of(body.begin(), body.end(), [](unsigned char c) {
                      return (c >= 0x20 && c < 0x7F) || c == '\n' || c == '\r';
                  });
    if (!isText)
        return "| (" + std::to_string(body.size()) + " bytes)\n";
    if (std::size_t at = type.find("boundary="); at != std::string::npos) {
        std::string boundary = type.substr(at + 9);
        for (std::size_t i; (i = body.find(boundary)) != std::string::npos;)
            body.replace(i, boundary.size(), "...");
    }
    std::string text;
    for (std::string line : linesOf(body)) {
        if (!line.empty() && line.back() == '\r')
            line.pop_back();
        text += line.empty() ? "|\n" : "| " + line + "\n";
    }
    return text;
}

// A connection stays open if it answers once more, and is closed if its end can be read.
std::string stateLine(RawClient& client) {
    if (client.isClosedWithin(0))
        return "= closed\n";
    RawResponse response = client.ask("GET /letters.txt HTTP/1.1\nHost: localhost");
    return response.status == 200 ? "= stays open\n" : "= closed\n";
}

// Sends lines that follow each other and returns what comes back. Each empty line ends a request.
std::string exchange(RawClient& client, const std::vector<std::string>& lines, const GoldenNames& names) {
    std::string bytes, text;
    std::vector<bool> hasBody; // of the answers
    bool isStart = true;
    for (const std::string& line : lines) {
        if (isStart && !line.empty()) {
            hasBody.push_back(!line.starts_with("HEAD "));
            isStart = false;
        }
        isStart = isStart || line.empty();
        bytes += replaced(line, names) + "\r\n";
    }
    client.send(bytes);
    for (bool has : hasBody) {
        RawResponse response = client.receive(has);
        if (response.status == 0)
            break;
        text += headLines(response) + bodyLines(response);
        if (!response.isComplete)
            text += "| (cut)\n";
    }
    return text;
}

} // namespace

std::string playGoldenCase(const std::string& caseText, std::uint16_t port, const GoldenNames& names,
                           bool isApart) {
    auto client = std::make_unique<RawClient>(port);
    std::string text;
    std::vector<std::string> request;
    bool isDescription = true;
    auto finishRequest = [&] {
        if (request.empty())
            return;
        text += exchange(*client, request, names);
        request.clear();
        if (isApart)
            client = std::make_unique<RawClient>(port);
    };
    for (const std::string& line : linesOf(caseText)) {
        if (line.starts_with(">")) {
            isDescription = false;
            text += line + "\n";
            request.push_back(line.size() > 2 ? line.substr(2) : "");
        } else {
            finishRequest();
            if (isDescription)
                text += line + "\n";
        }
    }
    finishRequest();
    return isApart ? text : text + stateLine(*client);
}

} // namespace stipple::test
