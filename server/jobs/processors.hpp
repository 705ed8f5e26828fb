// Which processors a thread may run on. A thread that is started takes over those of who starts it. (Linux.)
#pragma once

#include <vector>

namespace stipple::server {

// Those of the calling thread, ascending; empty if the system does not say.
std::vector<int> allowedProcessors();
// The calling thread runs on these from now on; without any, or where the system refuses, it stays as it is.
void runOn(const std::vector<int>& processors);

} // namespace stipple::server
