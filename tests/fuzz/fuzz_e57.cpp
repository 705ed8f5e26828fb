// Any bytes as an E57 file, with the checksums of its pages and the file's length made right, so that what
// lies behind them is reached: it is refused with a sentence, or all its points are read.
#include "converter/input/e57/e57_input.hpp"
#include "tests/unit/converter/input/e57/e57_bytes.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace {
void require(bool condition) {
    if (!condition)
        std::abort();
}

// Goes with the program.
struct ScratchFile {
    std::string path =
        std::filesystem::temp_directory_path() / ("stipple-fuzz-" + std::to_string(::getpid()) + ".e57");
    ~ScratchFile() { std::filesystem::remove(path); }
};

void readAll(const stipple::PointInput& input) {
    using namespace stipple;
    for (std::size_t part = 0; part < input.parts().size(); ++part) {
        auto stream = input.openPart(part);
        if (!stream)
            return require(!stream.error().sentence().empty());
        PointBatch batch;
        std::uint64_t points = 0;
        do {
            if (Status read = (*stream)->next(batch); !read)
                return require(!read.error().sentence().empty());
            points += batch.size();
        } while (batch.size() > 0);
        require(points == input.parts()[part].points);
    }
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    static const ScratchFile scratch;
    Bytes file(data, data + size);
    if (file.size() >= 48)
        storeLe<std::uint64_t>(file.data() + 16, file.size() / 1024 * 1024);
    test::mendE57Checksums(file);
    std::ofstream(scratch.path, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
    auto input = openE57Input(scratch.path);
    if (!input)
        require(!input.error().sentence().empty());
    else
        readAll(**input);
    return 0;
}
