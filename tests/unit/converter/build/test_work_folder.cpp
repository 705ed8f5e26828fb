#include "converter/build/work_folder.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

#include <csignal>
#include <sys/wait.h>

using namespace stipple;
using namespace stipple::test;
namespace fs = std::filesystem;

namespace {
struct Opened {
    std::unique_ptr<WorkFolder> folder;
    std::vector<std::string> warnings;
};

Opened open(const std::string& path, const std::string& identity) {
    Opened opened;
    auto folder = WorkFolder::open(path, identity, opened.warnings);
    if (!folder)
        FAIL(folder.error().sentence());
    opened.folder = std::move(folder).value();
    return opened;
}

Bytes bytesOf(const std::string& text) {
    return Bytes(text.begin(), text.end());
}

// Another process that has the folder open until it is ended.
class Holder {
  public:
    Holder(const std::string& path, const std::string& identity) {
        int ends[2];
        REQUIRE(::pipe(ends) == 0);
        child_ = ::fork();
        if (child_ == 0) {
            std::vector<std::string> warnings;
            auto folder = WorkFolder::open(path, identity, warnings);
            char ok = folder.ok() && (*folder)->save("record", bytesOf("half done")).ok() ? 'y' : 'n';
            if (::write(ends[1], &ok, 1) == 1)
                ::pause();
            ::_exit(1);
        }
        ::close(ends[1]);
        char answer = 0;
        CHECK(::read(ends[0], &answer, 1) == 1);
        CHECK(answer == 'y');
        ::close(ends[0]);
    }
    ~Holder() {
        ::kill(child_, SIGKILL);
        ::waitpid(child_, nullptr, 0);
    }
    Holder(const Holder&) = delete;
    Holder& operator=(const Holder&) = delete;

  private:
    pid_t child_ = -1;
};
} // namespace

TEST_CASE("a work folder goes with all that is in it", "[workfolder]") {
    TemporaryFolder folder;
    {
        Opened work = open(folder / "a/b/work", "x");
        CHECK_FALSE(work.folder->resumes());
        CHECK(work.warnings.empty());
        REQUIRE(work.folder->save("record", bytesOf("1")).ok());
        REQUIRE(work.folder->scratch("points", false).ok());
        CHECK(fs::exists(folder / "a/b/work/points"));
    }
    CHECK_FALSE(fs::exists(folder / "a/b/work"));
}

TEST_CASE("a kept work folder is taken up by the same conversion", "[workfolder]") {
    TemporaryFolder folder;
    {
        Opened work = open(folder / "work", "x");
        REQUIRE(work.folder->save("record", bytesOf("first")).ok());
        REQUIRE(work.folder->save("record", bytesOf("second")).ok());
        auto file = work.folder->scratch("points", false);
        REQUIRE(file.ok());
        REQUIRE((*file)->write((*file)->reserve(3), bytesOf("abc")).ok());
        work.folder->keep();
    }
    {
        Opened work = open(folder / "work", "x");
        CHECK(work.folder->resumes());
        CHECK(work.warnings.empty());
        auto record = work.folder->load("record");
        REQUIRE(record.ok());
        CHECK(*record == bytesOf("second"));
        auto file = work.folder->scratch("points", true);
        REQUIRE(file.ok());
        Bytes back(3);
        REQUIRE((*file)->read(0, back).ok());
        CHECK(back == bytesOf("abc"));
    }
    CHECK(folder.files() == 0); // finished this time: nobody asked to keep it
}

TEST_CASE("what another conversion left is discarded, and that is said", "[workfolder]") {
    TemporaryFolder folder;
    {
        Opened work = open(folder / "work", "x");
        REQUIRE(work.folder->save("record", bytesOf("1")).ok());
        work.folder->keep();
    }
    Opened work = open(folder / "work", "y");
    CHECK_FALSE(work.folder->resumes());
    REQUIRE(work.warnings.size() == 1);
    CHECK(work.warnings[0].find(folder / "work") != std::string::npos);
    CHECK(work.warnings[0].find("discarded") != std::string::npos);
    auto record = work.folder->load("record");
    REQUIRE_FALSE(record.ok());
    CHECK(record.error().code == ErrorCode::notFound);
}

TEST_CASE("a work folder in use by another process is left alone", "[workfolder]") {
    TemporaryFolder folder;
    {
        Holder holder(folder / "work", "x");
        for (const char* identity : {"x", "y"}) {
            std::vector<std::string> warnings;
            auto refused = WorkFolder::open(folder / "work", identity, warnings);
            REQUIRE_FALSE(refused.ok());
            CHECK(refused.error().code == ErrorCode::writeFailed);
            CHECK(refused.error().sentence().find("another conversion") != std::string::npos);
            CHECK(refused.error().where == folder / "work");
        }
        CHECK(fs::exists(folder / "work/record"));
    }
    // Killed: its lock is gone, its work is there.
    Opened work = open(folder / "work", "x");
    CHECK(work.folder->resumes());
    auto record = work.folder->load("record");
    REQUIRE(record.ok());
    CHECK(*record == bytesOf("half done"));
}

TEST_CASE("a damaged record is told from one that is not there", "[workfolder]") {
    TemporaryFolder folder;
    Opened work = open(folder / "work", "x");
    REQUIRE(work.folder->save("record", bytesOf("what was done")).ok());
    Bytes bytes = fileBytes(folder / "work/record");
    auto loadChanged = [&](const Bytes& changed) {
        fs::remove(folder / "work/record");
        std::ofstream(folder / "work/record", std::ios::binary)
            .write(reinterpret_cast<const char*>(changed.data()),
                   static_cast<std::streamsize>(changed.size()));
        auto record = work.folder->load("record");
        return record.ok() ? std::string("ok") : errorCodeName(record.error().code);
    };
    CHECK(loadChanged(bytes) == "ok");
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        Bytes changed = bytes;
        changed[at] ^= 0x10;
        CHECK(loadChanged(changed) == errorCodeName(ErrorCode::corrupt));
        CHECK(loadChanged(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(at))) != "ok");
    }
    CHECK(work.folder->load("none").error().code == ErrorCode::notFound);
}

TEST_CASE("a damaged identity is one of another conversion", "[workfolder]") {
    TemporaryFolder folder;
    open(folder / "work", "x").folder->keep();
    std::ofstream(folder / "work/identity", std::ios::binary | std::ios::trunc) << "x";
    std::ofstream(folder / "work/points") << "old";
    Opened work = open(folder / "work", "x");
    CHECK_FALSE(work.folder->resumes());
    CHECK_FALSE(fs::exists(folder / "work/points"));
}

TEST_CASE("a work folder that can't be made says which and why", "[workfolder]") {
    TemporaryFolder folder;
    std::ofstream(folder / "file") << "something of value";
    std::vector<std::string> warnings;
    for (const char* name : {"file", "file/work"}) {
        auto refused = WorkFolder::open(folder / name, "x", warnings);
        REQUIRE_FALSE(refused.ok());
        CHECK(refused.error().code == ErrorCode::writeFailed);
        CHECK(refused.error().where == folder / name);
        CHECK(refused.error().advice.find("--temp") != std::string::npos);
    }
    CHECK(fileBytes(folder / "file").size() == 18);
}
