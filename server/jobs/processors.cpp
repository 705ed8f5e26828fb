#include "server/jobs/processors.hpp"

#include <sched.h>

namespace stipple::server {

std::vector<int> allowedProcessors() {
    cpu_set_t set;
    std::vector<int> processors;
    if (::sched_getaffinity(0, sizeof set, &set) != 0) // more than the set has room for
        return processors;
    for (int i = 0; i < CPU_SETSIZE; ++i)
        if (CPU_ISSET(i, &set))
            processors.push_back(i);
    return processors;
}

void runOn(const std::vector<int>& processors) {
    cpu_set_t set;
    CPU_ZERO(&set);
    for (int processor : processors)
        CPU_SET(processor, &set);
    if (!processors.empty())
        ::sched_setaffinity(0, sizeof set, &set);
}

} // namespace stipple::server
