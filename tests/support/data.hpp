// The real scans that some tests read. They are no part of the project; where the folder is absent a test
// says so and passes over.
#pragma once

#include <catch2/catch.hpp>

#include <filesystem>
#include <string>

namespace stipple::test {

inline std::string dataPath(const std::string& relative) {
    return std::string(STIPPLE_DATA_DIR) + "/" + relative;
}
inline bool haveData() {
    return std::filesystem::exists(STIPPLE_DATA_DIR);
}

} // namespace stipple::test

// First line of a test that needs the scans.
#define STIPPLE_NEEDS_DATA()                                                                                 \
    do {                                                                                                     \
        if (!stipple::test::haveData()) {                                                                    \
            WARN("skipped: the real scans are not at " STIPPLE_DATA_DIR);                                    \
            return;                                                                                          \
        }                                                                                                    \
    } while (false)
