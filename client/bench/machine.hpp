// What measured times are worth: the machine, and how busy it was.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace stipple::bench {

struct Machine {
    std::string processor; // "AMD EPYC 7763"; empty where the system doesn't say
    int cores = 0;
    double memoryGiB = 0;
    std::string system;   // "Debian GNU/Linux 12 (bookworm)"
    std::string compiler; // of this program
    std::string time;     // when the bench began, UTC: "2026-11-26T11:00:00Z"
    // Processes that were waiting for a core in the minute before (load average): far above 0, other work was
    // going on, and times are indications.
    double loadBefore = 0;
};

Machine thisMachine();
nlohmann::json toJson(const Machine& machine);

} // namespace stipple::bench
