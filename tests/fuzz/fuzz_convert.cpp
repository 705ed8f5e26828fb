// Any bytes as a scan, of the kind they begin like: the conversion refuses them, or makes a cloud that holds
// exactly their points.
#include "converter/build/verify.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace {
// Goes with the program.
struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("stipple-fuzz-" + std::to_string(::getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
};

[[noreturn]] void stopOn(const std::string& what) {
    std::fprintf(stderr, "%s\n", what.c_str());
    std::abort();
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    static const Folder folder;
    const std::string scan = folder.path / "in.las", cloud = folder.path / "out.stipple";
    std::ofstream(scan, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    ConvertOptions options;
    options.threads = 1;
    auto quiet = [](const std::string&, std::uint64_t, std::uint64_t) {};
    auto converted = convertFiles({scan}, cloud, options, quiet);
    if (!converted)
        return 0;
    auto report = verifyFile(cloud, {scan}, {.threads = 1}, quiet);
    if (!report)
        stopOn(report.error().sentence());
    if (!report->passed())
        stopOn(report->faults.empty() ? report->comparison->first[0].text : report->faults[0]);
    return 0;
}
