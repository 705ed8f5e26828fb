#include "converter/build/memory_share.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <filesystem>
#include <unistd.h>

namespace stipple {

std::uint64_t memoryForPoints(std::uint64_t requestedBytes) {
    if (requestedBytes > 0)
        return requestedBytes;
    auto pages = static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PHYS_PAGES)));
    auto pageBytes = static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PAGESIZE)));
    return std::max(leastMemoryBytes, pages * pageBytes / 4);
}

Status refuseFullDisk(std::uint64_t pointBytes, std::uint64_t memoryBytes, const std::string& folder) {
    std::error_code failed;
    std::filesystem::space_info space = std::filesystem::space(folder, failed);
    if (failed || pointBytes <= memoryBytes || pointBytes <= space.available)
        return {};
    return Error{ErrorCode::writeFailed,
                 cat("the points need ", pointBytes >> 20, " MiB for the time being, but the disk has ",
                     space.available >> 20, " MiB free"),
                 folder, "free space, name another folder with --temp, or allow more --memory"};
}

} // namespace stipple
