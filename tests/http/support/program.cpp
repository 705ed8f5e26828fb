#include "tests/http/support/program.hpp"

#include "tests/http/support/test_server.hpp"

#include <catch2/catch.hpp>
#include <csignal>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

namespace stipple::test {

Program::Program(std::vector<std::string> arguments, const std::filesystem::path& errors,
                 rlim_t descriptors) {
    int ends[2];
    REQUIRE(::pipe(ends) == 0);
    child_ = ::fork();
    if (child_ == 0) {
        ::dup2(ends[1], 1);
        if (std::freopen(errors.c_str(), "w", stderr) == nullptr)
            ::_exit(99);
        ::close(ends[0]);
        if (descriptors > 0) {
            struct rlimit limit {
                descriptors, descriptors
            };
            ::setrlimit(RLIMIT_NOFILE, &limit);
        }
        arguments.insert(arguments.begin(), STIPPLE_PROGRAM);
        std::vector<char*> raw;
        for (std::string& argument : arguments)
            raw.push_back(argument.data());
        raw.push_back(nullptr);
        ::execv(raw[0], raw.data());
        ::_exit(99);
    }
    ::close(ends[1]);
    output_ = ::fdopen(ends[0], "r");
}

Program::~Program() {
    if (child_ > 0) {
        ::kill(child_, SIGKILL);
        wait();
    }
    std::fclose(output_);
}

std::string Program::line() {
    std::string text;
    for (int c; (c = std::fgetc(output_)) != EOF && c != '\n';)
        text += static_cast<char>(c);
    return text;
}

double Program::cpuSeconds() const {
    std::string stat = readFile("/proc/" + std::to_string(child_) + "/stat");
    unsigned long user = 0, system = 0;
    std::sscanf(stat.c_str() + stat.rfind(')') + 2, "%*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu",
                &user, &system);
    return static_cast<double>(user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

void Program::signal(int number) const {
    ::kill(child_, number);
}

int Program::wait() {
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

std::uint16_t portOf(const std::string& jsonLine) {
    auto json = nlohmann::json::parse(jsonLine, nullptr, false);
    REQUIRE(json.is_object());
    return json["port"].get<std::uint16_t>();
}

} // namespace stipple::test
