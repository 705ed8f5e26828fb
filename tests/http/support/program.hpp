// The program `stipple` as a child: arguments in, lines and an exit code out. Killed with the test.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <sys/resource.h>
#include <sys/types.h>
#include <vector>

namespace stipple::test {

class Program {
  public:
    // Standard error goes to the file `errors`. `descriptors`: its limit; 0: as it is.
    Program(std::vector<std::string> arguments, const std::filesystem::path& errors, rlim_t descriptors = 0);
    ~Program();
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    std::string line();        // the next of standard output, without its end
    double cpuSeconds() const; // that it has used
    void signal(int number) const;
    int wait(); // exit code; 1000 + signal

  private:
    pid_t child_ = 0;
    std::FILE* output_ = nullptr;
};

// Of the line that `stipple serve --json` prints.
std::uint16_t portOf(const std::string& jsonLine);

} // namespace stipple::test
