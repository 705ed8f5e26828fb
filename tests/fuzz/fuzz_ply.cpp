#include "converter/input/ply_input.hpp"
#include "tests/fuzz/read_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return stipple::fuzz::readInput(stipple::openPlyInput, data, size);
}
