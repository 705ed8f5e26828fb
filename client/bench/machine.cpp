#include "client/bench/machine.hpp"

#include <nlohmann/json.hpp>

#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>

namespace stipple::bench {
namespace {

// The rest of the first line of `path` that starts with `key`, without what is put around values.
std::string valueIn(const char* path, const std::string& key) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        if (line.rfind(key, 0) != 0)
            continue;
        std::size_t first = line.find_first_not_of("\t :=\"", key.size());
        std::size_t last = line.find_last_not_of("\" ");
        return first == std::string::npos ? "" : line.substr(first, last - first + 1);
    }
    return "";
}

std::string now() {
    std::time_t time = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&time, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text;
}

} // namespace

Machine thisMachine() {
    Machine machine;
    machine.processor = valueIn("/proc/cpuinfo", "model name");
    machine.cores = static_cast<int>(std::thread::hardware_concurrency());
    machine.memoryGiB = static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                        static_cast<double>(sysconf(_SC_PAGE_SIZE)) / (1 << 30);
    machine.system = valueIn("/etc/os-release", "PRETTY_NAME");
#ifdef __VERSION__
    machine.compiler = __VERSION__;
#endif
    machine.time = now();
    double load[1] = {0};
    if (getloadavg(load, 1) == 1)
        machine.loadBefore = load[0];
    return machine;
}

nlohmann::json toJson(const Machine& machine) {
    return {{"processor", machine.processor},  {"cores", machine.cores},
            {"memoryGiB", machine.memoryGiB},  {"system", machine.system},
            {"compiler", machine.compiler},    {"time", machine.time},
            {"loadBefore", machine.loadBefore}};
}

} // namespace stipple::bench
