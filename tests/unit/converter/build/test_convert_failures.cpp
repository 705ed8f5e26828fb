// Conversions that fail, as a user sees them: what is said, the exit code, and what is left behind.
#include "converter/build/verify.hpp"
#include "shared/cli/verb.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fcntl.h>
#include <limits>
#include <optional>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>

using namespace stipple;
using namespace stipple::test;
namespace fs = std::filesystem;

namespace {
struct Ended {
    int code = -1;
    std::string said; // on both outputs
    bool says(const std::string& text) const { return said.find(text) != std::string::npos; }
};

// Runs a line of shell, in which $stipple is the program.
Ended shell(const std::string& line) {
    Ended ended;
    std::FILE* pipe = ::popen(("stipple='" STIPPLE_PROGRAM "'; exec 2>&1; " + line).c_str(), "r");
    REQUIRE(pipe != nullptr);
    std::array<char, 4096> part{};
    while (std::size_t size = std::fread(part.data(), 1, part.size(), pipe))
        ended.said.append(part.data(), size);
    int status = ::pclose(pipe);
    ended.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    return ended;
}

// A line that runs where only it sees what it mounts, if that is allowed here.
std::string withMounts(const std::string& line) {
    return "unshare -m sh -c '" + line + "'";
}
bool mayMount(const TemporaryFolder& folder) {
    fs::create_directory(folder / "probe");
    if (shell(withMounts("mount -t tmpfs none " + (folder / "probe"))).code == 0)
        return true;
    WARN("skipped: this process may not mount file systems");
    return false;
}

// A small disk, which this process alone sees from now on. Nothing where it may not mount one.
class SmallDisk {
  public:
    static std::unique_ptr<SmallDisk> mount(const std::string& path, const std::string& size) {
        fs::create_directory(path);
        if (::unshare(CLONE_NEWNS) == 0 && ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
            ::mount("none", path.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0)
            return std::unique_ptr<SmallDisk>(new SmallDisk(path));
        WARN("skipped: this process may not mount file systems");
        return nullptr;
    }
    ~SmallDisk() { ::umount2(path_.c_str(), MNT_DETACH); }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;

    // What another program may do at any time. Thread: any.
    void fill() const {
        int file = ::open(filler().c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
        const Bytes page(1 << 16, 1);
        while (::write(file, page.data(), page.size()) > 0)
            continue;
        ::close(file);
    }
    void empty() const { fs::remove(filler()); }

  private:
    explicit SmallDisk(std::string path) : path_(std::move(path)) {}
    std::string filler() const { return path_ + "/filler"; }
    std::string path_;
};

// Some 10 MB; its cloud is about 3 MB.
void writeLarge(const std::string& path) {
    writeScan(surfaceScan(1, 400000, 1), path);
}

// Changes bytes of a file in place.
void patch(const std::string& path, std::size_t at, const Bytes& bytes) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(at));
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    REQUIRE(file.good());
}

std::string convertLine(const std::string& input, const std::string& output) {
    return "\"$stipple\" convert " + input + " -o " + output + " --progress none";
}

ConvertOptions pieces(std::uint64_t memoryBytes) {
    ConvertOptions options;
    options.memoryBytes = memoryBytes;
    options.threads = 2;
    options.sizes = {.pointsPerRound = 20000, .subtreeBytes = std::uint64_t{1} << 22};
    return options;
}

// Six files of 20,000 points: more than the least pool of buffers holds.
std::vector<std::string> writeSix(const TemporaryFolder& folder) {
    std::vector<std::string> inputs;
    for (std::size_t i = 0; i < 6; ++i) {
        inputs.push_back(folder / ("in" + std::to_string(i) + ".las"));
        writeScan(surfaceScan(1, 20000, i), inputs.back());
    }
    return inputs;
}
} // namespace

TEST_CASE("a full disk is one sentence, exit code 4, and leaves nothing", "[failures]") {
    TemporaryFolder folder;
    if (!mayMount(folder))
        return;
    writeLarge(folder / "in.las");
    fs::create_directory(folder / "small");
    const std::string small = folder / "small";
    auto convertThere = [&](const std::string& output, const std::string& options) {
        return shell("export stipple; " +
                     withMounts("mount -t tmpfs -o size=2m none " + small + " && " +
                                convertLine(folder / "in.las", output) + options +
                                "; code=$?; echo left: $(ls -A " + small + ")!; exit $code"));
    };
    for (const auto& [output, options] :
         {std::pair<std::string, std::string>{small + "/out.stipple", ""},
          std::pair<std::string, std::string>{folder / "out.stipple", " --temp " + small},
          // The points find room on another disk, the cloud does not.
          std::pair<std::string, std::string>{small + "/out.stipple", " --temp " + (folder / "temp")}}) {
        Ended ended = convertThere(output, options);
        INFO(ended.said);
        CHECK(ended.code == cli::outputError);
        CHECK(ended.says("No space left on device (free space on that disk, or "));
        CHECK(ended.says("left: !"));
        CHECK_FALSE(fs::exists(folder / "out.stipple"));
    }
    CHECK((!fs::exists(folder / "temp") || fs::is_empty(folder / "temp")));
}

TEST_CASE("a limit on the size of files is said like a full disk", "[failures]") {
    TemporaryFolder folder;
    writeLarge(folder / "in.las");
    Ended ended =
        shell("ulimit -f 1000; " + convertLine(folder / "in.las", folder / "out.stipple")); // × 512 or 1024
    INFO(ended.said);
    CHECK(ended.code == cli::outputError);
    CHECK(ended.says("File too large (raise the limit on the size of files (ulimit -f))"));
    CHECK(folder.files() == 1);
}

TEST_CASE("a target that can't be written is refused before anything is read", "[failures]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 1000, 1), folder / "in.las");
    std::ofstream(folder / "file") << "no folder";
    Ended inFile = shell(convertLine(folder / "in.las", folder / "file/out.stipple"));
    INFO(inFile.said);
    CHECK(inFile.code == cli::outputError);
    CHECK(inFile.says("the folder of the output does not exist"));
    Ended temp =
        shell(convertLine(folder / "in.las", folder / "out.stipple") + " --temp " + (folder / "file"));
    INFO(temp.said);
    CHECK(temp.code == cli::outputError);
    CHECK(temp.says("the folder for temporary files can't be made"));
    CHECK(folder.files() == 2);

    if (!mayMount(folder))
        return;
    fs::create_directory(folder / "fixed");
    Ended fixed = shell("export stipple; " +
                        withMounts("cd " + (folder / "fixed") + " && mount --bind . . && cd . && mount -o " +
                                   "remount,ro,bind " + (folder / "fixed") + " && " +
                                   convertLine(folder / "in.las", folder / "fixed/out.stipple") + " --temp " +
                                   (folder / "temp")));
    INFO(fixed.said);
    CHECK(fixed.code == cli::outputError);
    CHECK(fixed.says("the folder of the output can't be written: Read-only file system (choose another"));
    CHECK_FALSE(fs::exists(folder / "temp"));
}

TEST_CASE("an input that vanishes while it is read is named", "[failures]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(1, 300000, 1), folder / "in.las");
    patch(folder / "in.las", 179, Bytes(48, 0xFF)); // bounds that are no numbers: it is read twice
    ConvertOptions options;
    options.threads = 1;
    auto result = convertFiles({folder / "in.las"}, folder / "out.stipple", options,
                               [&](const std::string& phase, std::uint64_t done, std::uint64_t total) {
                                   if (phase == "measure" && done == total)
                                       fs::remove(folder / "in.las");
                               });
    REQUIRE_FALSE(result.ok());
    CHECK(cli::exitCodeOf(result.error()) == cli::inputError);
    CHECK(result.error().sentence() ==
          (folder / "in.las") + ": can't be opened: No such file or directory (check the name)");
    CHECK(folder.files() == 0);
}

TEST_CASE("a LAZ chunk that ends too early is placed", "[failures]") {
    TemporaryFolder folder;
    TestScan scan = surfaceScan(1, 120000, 1); // chunks of 50,000
    las::WriterOptions options;
    options.grid = scan.grid;
    options.schema = scan.schema;
    options.pointFormat = 1;
    options.compressed = true;
    auto writer = las::Writer::create(folder / "in.laz", options);
    REQUIRE(writer.ok());
    REQUIRE((*writer)->write(scan.points).ok());
    REQUIRE((*writer)->finish().ok());
    Bytes bytes = fileBytes(folder / "in.laz");

    std::ofstream(folder / "cut.laz", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size() / 2));
    Ended cut = shell(convertLine(folder / "cut.laz", folder / "out.stipple"));
    INFO(cut.said);
    CHECK(cut.code == cli::inputError);
    CHECK(cut.says("cut.laz, the chunk of points from 50000 on, at byte "));
    CHECK(cut.says("ends before its last point"));
    CHECK_FALSE(fs::exists(folder / "out.stipple"));

    // The last chunk ends early: its bytes are missing, the chunk table stands behind.
    std::uint64_t table = loadLe<std::uint64_t>(bytes.data() + loadLe<std::uint32_t>(bytes.data() + 96));
    const std::ptrdiff_t gap = 40000;
    Bytes shorter(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(table) - gap);
    shorter.insert(shorter.end(), bytes.begin() + static_cast<std::ptrdiff_t>(table), bytes.end());
    storeLe<std::uint64_t>(shorter.data() + loadLe<std::uint32_t>(bytes.data() + 96),
                           table - static_cast<std::uint64_t>(gap));
    std::ofstream(folder / "short.laz", std::ios::binary)
        .write(reinterpret_cast<const char*>(shorter.data()), static_cast<std::streamsize>(shorter.size()));
    Ended lost = shell(convertLine(folder / "short.laz", folder / "out.stipple"));
    INFO(lost.said);
    CHECK(lost.code == cli::inputError);
    CHECK(lost.says("short.laz, the chunk of points from 100000 on, at byte "));
    CHECK(folder.files() == 3);
}

TEST_CASE("headers that lie about bounds and counts are corrected, and that is said", "[failures]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 1000, 1), folder / "in.las");
    Bytes far(8);
    storeLe<double>(far.data(), 9e7);
    patch(folder / "in.las", 179, far);
    patch(folder / "in.las", 107, {0, 0, 0, 0x7F}); // number of points
    Ended ended = shell(convertLine(folder / "in.las", folder / "out.stipple"));
    INFO(ended.said);
    CHECK(ended.code == cli::success);
    CHECK(ended.says("warning: "));
    CHECK(ended.says("the header counts 2130706432 points, but the file ends after 1000"));
    CHECK(ended.says("to 90000000, but the points lie from"));
}

TEST_CASE("points of more bytes than a buffer are refused", "[failures]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 10, 1), folder / "in.las");
    Bytes bytes = fileBytes(folder / "in.las");
    std::size_t points = loadLe<std::uint32_t>(bytes.data() + 96);
    storeLe<std::uint16_t>(bytes.data() + 105, 65535); // the length of a record
    bytes.resize(points + 10 * 65535);
    std::ofstream(folder / "in.las", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    Ended ended = shell(convertLine(folder / "in.las", folder / "out.stipple"));
    INFO(ended.said);
    CHECK(ended.code == cli::inputError);
    CHECK(ended.says("but at most 65536 can be converted"));
    CHECK(folder.files() == 1);
}

TEST_CASE("a conversion in memory that is stopped in any phase leaves nothing", "[failures]") {
    TemporaryFolder folder;
    auto inputs = writeSix(folder);
    for (const char* phase : {"tile", "sample"})
        for (double part : {0.0, 0.5}) {
            INFO("stopped in phase " << phase << " at " << part);
            std::atomic<bool> stop{false};
            ConvertOptions options = pieces(0);
            options.stop = &stop;
            auto result = convertFiles(inputs, folder / "out.stipple", options,
                                       [&](const std::string& now, std::uint64_t done, std::uint64_t total) {
                                           if (now == phase &&
                                               static_cast<double>(done) >= part * static_cast<double>(total))
                                               stop = true;
                                       });
            REQUIRE_FALSE(result.ok());
            CHECK(cli::exitCodeOf(result.error()) == cli::interrupted);
            CHECK(result.error().sentence() == "interrupted (nothing is left behind)");
            CHECK(folder.files() == inputs.size());
        }
}

namespace {
// Writes a text file of about so many bytes, which is read from end to end when it is opened.
void writeText(const std::string& path, std::size_t bytes) {
    std::string lines;
    for (int i = 0; i < 1000; ++i)
        lines +=
            std::to_string(i * 7 % 1000) + ".125 " + std::to_string(i * 13 % 1000) + ".25 0.5 120 90 33\n";
    std::ofstream file(path);
    for (std::size_t written = 0; written < bytes; written += lines.size())
        file << lines;
}
} // namespace

TEST_CASE("a conversion that is stopped while its inputs are opened ends soon and leaves nothing",
          "[failures]") {
    TemporaryFolder folder;
    writeText(folder / "in.txt", std::size_t{400} << 20);
    // The program says when it got the signal; far more than it may take are left to be read.
    Ended ended = shell("cd '" + (folder / "") +
                        "'; \"$stipple\" convert in.txt -o out.stipple --progress none & "
                        "sleep 0.3; kill -INT $!; sent=$(date +%s%N); wait $!; code=$?; "
                        "echo took $(( ($(date +%s%N) - sent) / 1000000 )) ms; exit $code");
    INFO(ended.said);
    CHECK(ended.code == cli::interrupted);
    CHECK(ended.says("interrupted (nothing is left behind)"));
    CHECK(folder.files() == 1);
    std::size_t at = ended.said.find("took ");
    REQUIRE(at != std::string::npos);
    CHECK(std::stoi(ended.said.substr(at + 5)) < 500);
}

TEST_CASE("every kind of input that is read when it is opened stops there", "[failures]") {
    TemporaryFolder folder;
    std::atomic<bool> stop{true};
    writeText(folder / "in.txt", 1000);
    std::ofstream(folder / "in.ply") << "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\n"
                                        "property double y\nproperty double z\nend_header\n1 2 3\n";
    for (const char* name : {"in.txt", "in.ply"}) {
        InputOptions reading;
        reading.stop = &stop;
        auto opened = openInput(folder / name, reading);
        REQUIRE_FALSE(opened.ok());
        CHECK(opened.error().code == ErrorCode::cancelled);
        ConvertOptions options;
        options.stop = &stop;
        auto result = convertFiles({folder / name}, folder / "out.stipple", options, noProgress);
        REQUIRE_FALSE(result.ok());
        CHECK(result.error().sentence() == "interrupted (nothing is left behind)");
    }
    // What an earlier run left is not touched, and is spoken of.
    fs::create_directory(folder / "out.stipple.work");
    ConvertOptions options;
    options.stop = &stop;
    auto result = convertFiles({folder / "in.txt"}, folder / "out.stipple", options, noProgress);
    REQUIRE_FALSE(result.ok());
    CHECK(result.error().sentence().find("stays in " + (folder / "out.stipple.work")) != std::string::npos);
    CHECK(fs::exists(folder / "out.stipple.work"));
}

TEST_CASE("a conversion that is stopped while the file is written leaves nothing of it", "[failures]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(1, 20000, 1), folder / "in.las");
    CloudMetadata metadata = convertOrFail({folder / "in.las"}, folder / "whole.stipple").metadata;
    auto blocks = ScratchFile::create(folder / "blocks");
    REQUIRE(blocks.ok());
    EncodedNode node;
    node.pointCount = static_cast<std::uint32_t>(metadata.pointCount);
    node.attributes.resize(attributeBlocks(metadata).size());
    auto stored = storeNode(node, **blocks);
    REQUIRE(stored.ok());
    std::atomic<bool> stop{true};
    auto written = assembleCloud(folder / "out.stipple", metadata, {*stored}, **blocks, &stop);
    REQUIRE_FALSE(written.ok());
    INFO(written.error().sentence());
    CHECK(written.error().code == ErrorCode::cancelled);
    CHECK(!fs::exists(folder / "out.stipple"));
    for (const auto& entry : fs::directory_iterator(folder / ""))
        CHECK(entry.path().filename().string().find("out.stipple") == std::string::npos);
}

TEST_CASE("a conversion on disk that is stopped keeps its checkpoint, and goes on to the same bytes",
          "[failures]") {
    TemporaryFolder folder;
    auto inputs = writeSix(folder);
    convertOrFail(inputs, folder / "whole.stipple", [] {
        ConvertOptions options = pieces(1);
        options.name = "out";
        return options;
    }());
    Bytes whole = fileBytes(folder / "whole.stipple");
    for (const char* phase : {"tile", "sample"})
        for (double part : {0.5, 0.8}) {
            INFO("stopped in phase " << phase << " at " << part);
            std::atomic<bool> stop{false};
            ConvertOptions options = pieces(1);
            options.stop = &stop;
            auto stopped = convertFiles(inputs, folder / "out.stipple", options,
                                        [&](const std::string& now, std::uint64_t done, std::uint64_t total) {
                                            if (now == phase && static_cast<double>(done) >=
                                                                    part * static_cast<double>(total))
                                                stop = true;
                                        });
            REQUIRE_FALSE(stopped.ok());
            CHECK(cli::exitCodeOf(stopped.error()) == cli::interrupted);
            CHECK(stopped.error().sentence().find("is kept in " + (folder / "out.stipple.work")) !=
                  std::string::npos);
            CHECK_FALSE(fs::exists(folder / "out.stipple"));
            CHECK(fs::exists(folder / "out.stipple.work"));
            ConvertResult resumed = convertOrFail(inputs, folder / "out.stipple", pieces(1));
            CHECK(resumed.resumed);
            CHECK((fileBytes(folder / "out.stipple") == whole));
            CHECK_FALSE(fs::exists(folder / "out.stipple.work"));
            fs::remove(folder / "out.stipple");
        }
}

TEST_CASE("a disk that fills up while points are on it keeps the checkpoint, and nothing else",
          "[failures]") {
    TemporaryFolder folder;
    auto disk = SmallDisk::mount(folder / "disk", "100m");
    if (!disk)
        return;
    auto inputs = writeSix(folder);
    ConvertOptions options = pieces(1);
    options.name = "out";
    convertOrFail(inputs, folder / "whole.stipple", options);
    const Bytes whole = fileBytes(folder / "whole.stipple");
    const std::string output = folder / "disk/out.stipple";
    for (const auto& [phase, part] :
         {std::pair<std::string, double>{"tile", 0.5}, std::pair<std::string, double>{"tile", 1},
          std::pair<std::string, double>{"sample", 0.4}, std::pair<std::string, double>{"sample", 1}}) {
        INFO("full in phase " << phase << " at " << part);
        std::atomic<bool> isFull{false};
        auto full = convertFiles(
            inputs, output, options, [&](const std::string& now, std::uint64_t done, std::uint64_t total) {
                bool due = now == phase && static_cast<double>(done) >= part * static_cast<double>(total);
                if (due && !isFull.exchange(true))
                    disk->fill();
            });
        REQUIRE_FALSE(full.ok());
        INFO(full.error().sentence());
        CHECK(cli::exitCodeOf(full.error()) == cli::outputError);
        CHECK(full.error().sentence().find("No space left on device (free space on that disk, or ") !=
              std::string::npos);
        CHECK(full.error().sentence().find("is kept in " + output + ".work: the same command goes on") !=
              std::string::npos);
        disk->empty();
        CHECK(std::distance(fs::directory_iterator(folder / "disk"), fs::directory_iterator()) == 1);
        CHECK(fs::exists(output + ".work/tiles"));
        ConvertResult resumed = convertOrFail(inputs, output, options);
        CHECK(resumed.resumed);
        CHECK((fileBytes(output) == whole));
        CHECK_FALSE(fs::exists(output + ".work"));
        fs::remove(output);
    }
}

TEST_CASE("where memory runs out, what went to disk stays, and goes on later to the same bytes",
          "[failures]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(3, 1200000, 1), folder / "in.las"); // 46 MB of rows, of which 32 stay in memory
    auto line = [&](const std::string& output) {
        return convertLine(folder / "in.las", folder / output) +
               " --name out --memory 64M --threads 2 --json";
    };
    REQUIRE(shell(line("whole.stipple")).code == cli::success);
    const Bytes whole = fileBytes(folder / "whole.stipple");
    const std::string output = folder / "out.stipple";
    int kept = 0, failed = 0;
    for (int megabytes : {60, 100, 120, 140, 160, 180, 240}) {
        Ended ended = shell("ulimit -v " + std::to_string(megabytes * 1024) + "; " + line("out.stipple"));
        INFO(megabytes << " MB: " << ended.said);
        if (ended.code != cli::success) {
            ++failed;
            CHECK(ended.code == cli::outputError);
            CHECK(ended.says("there is not enough memory"));
            CHECK(std::count(ended.said.begin(), ended.said.end(), '\n') == 1); // one sentence
            CHECK_FALSE(fs::exists(output));
        }
        if (fs::exists(output + ".work")) {
            ++kept;
            CHECK(ended.says("is kept in " + output + ".work"));
            Ended resumed = shell(line("out.stipple"));
            CHECK(resumed.says("\"resumed\": true"));
        }
        if (fs::exists(output))
            CHECK((fileBytes(output) == whole));
        fs::remove(output);
        CHECK(folder.files() == 2);
    }
    CHECK(failed >= 3);
    CHECK(kept >= 1);
}

TEST_CASE("strict conversions refuse a scan that was cut inside its points", "[failures]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(1, 1000, 1), folder / "cut.las");
    fs::resize_file(folder / "cut.las", fs::file_size(folder / "cut.las") - 100 * 28 + 5);
    writeScan(surfaceScan(1, 50, 2), folder / "whole.las");
    std::string both = folder / "whole.las " + (folder / "cut.las");
    Ended lenient = shell(convertLine(both, folder / "out.stipple"));
    INFO(lenient.said);
    CHECK(lenient.code == cli::success);
    CHECK(lenient.says("the header counts 1000 points, but the file ends after 900"));
    Ended strict = shell(convertLine(both, folder / "strict.stipple") + " --strict");
    INFO(strict.said);
    CHECK(strict.code == cli::inputError);
    CHECK(strict.says(folder / "cut.las: 100 of the 1000 points that it counts are not in it"));
    CHECK(folder.files() == 3);
}

TEST_CASE("strict conversions name each file, how many points it loses, and why", "[failures]") {
    TemporaryFolder folder;
    const std::string header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double "
                               "y\nproperty double z\nend_header\n";
    std::ofstream(folder / "a.ply") << header << "1 2 3\nnan 2 3\n4 inf 6\n1e300 5 6\n";
    std::ofstream(folder / "b.ply") << header << "1 2 3\n4 5 6\n7 8 9\nnan nan nan\n";
    std::ofstream(folder / "c.ptx")
        << "2\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"
           "0 0 0 0.5\n1 2 3 0.5\n";
    std::ofstream(folder / "d.ply") << header << "1 2 3\n4 5 6\n7 8 9\n1 1 1\n";
    Ended strict = shell(convertLine(folder / "*.p*", folder / "out.stipple") + " --strict");
    INFO(strict.said);
    CHECK(strict.code == cli::inputError);
    CHECK(strict.says(folder / "a.ply: 2 points were dropped: a coordinate is no finite number; 1 point was "
                               "dropped: a coordinate is farther out than a grid can count; " +
                      (folder / "b.ply: 1 point was dropped: a coordinate is no finite number; ") +
                      (folder / "c.ptx: 1 point was dropped: the file marks them as invalid (convert without "
                                "--strict to leave them out)")));
    CHECK(folder.files() == 4);
    Ended lenient = shell(convertLine(folder / "*.p*", folder / "out.stipple"));
    INFO(lenient.said);
    CHECK(lenient.code == cli::success);
    CHECK(lenient.says("warning: " +
                       (folder / "b.ply: 1 point was dropped: a coordinate is no finite number")));
    CHECK(lenient.says(": 9 points in "));
}
