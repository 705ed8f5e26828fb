#include "converter/build/built_subtree.hpp"
#include "tests/unit/converter/build/file_size_limit.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

#include <optional>

using namespace stipple;
using namespace stipple::test;

namespace {
NodeKey randomKey(std::mt19937_64& random) {
    return {static_cast<std::uint8_t>(random() % 32), static_cast<std::uint32_t>(random()),
            static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random())};
}

// `size`: nodes, values of a histogram and border points, about.
BuiltSubtree randomSubtree(std::uint64_t seed, std::size_t size) {
    std::mt19937_64 random(seed);
    BuiltSubtree built;
    built.tier = static_cast<int>(random() % 5);
    built.key = randomKey(random);
    built.points = random();
    built.hash = {random(), random()};
    for (int a = 0; a < 3; ++a) {
        PartialStatistics& s = built.statistics.emplace_back();
        s.count = random();
        s.min = -static_cast<double>(random() % 1000) / 7;
        s.max = static_cast<double>(random() % 1000) / 3;
        s.mean = 0.1;
        s.squares = 1e300;
        s.histogram.reset();
        if (a > 0)
            s.histogram.emplace();
        for (std::size_t i = 0; a == 2 && i < size; ++i)
            s.histogram->emplace(static_cast<std::int64_t>(random()), random());
    }
    for (std::size_t i = 0; i < size; ++i) {
        StoredNode& node = built.nodes.emplace_back();
        node.key = randomKey(random);
        node.pointCount = static_cast<std::uint32_t>(random());
        for (std::uint32_t& bytes : node.strataBytes)
            bytes = static_cast<std::uint32_t>(random());
        for (std::size_t block = 0; block < i % 3; ++block)
            node.attributeBytes.push_back(static_cast<std::uint32_t>(random()));
        node.offset = random();
        std::vector<Vec3i>& border = built.borders[randomKey(random)];
        for (std::size_t p = 0; p < i; ++p)
            border.push_back({static_cast<std::int64_t>(random()), static_cast<std::int64_t>(random()), -1});
    }
    built.sampleOffset = random();
    built.samplePoints = random();
    return built;
}

void checkSame(const BuiltSubtree& a, const BuiltSubtree& b) {
    CHECK(a.tier == b.tier);
    CHECK(a.key == b.key);
    CHECK(a.points == b.points);
    CHECK(a.hash == b.hash);
    CHECK(a.sampleOffset == b.sampleOffset);
    CHECK(a.samplePoints == b.samplePoints);
    CHECK((a.borders == b.borders));
    REQUIRE(a.statistics.size() == b.statistics.size());
    for (std::size_t i = 0; i < a.statistics.size(); ++i) {
        const PartialStatistics &s = a.statistics[i], &t = b.statistics[i];
        CHECK((s.count == t.count && s.min == t.min && s.max == t.max && s.mean == t.mean &&
               s.squares == t.squares && s.histogram == t.histogram));
    }
    REQUIRE(a.nodes.size() == b.nodes.size());
    for (std::size_t i = 0; i < a.nodes.size(); ++i) {
        const StoredNode &m = a.nodes[i], &n = b.nodes[i];
        CHECK((m.key == n.key && m.pointCount == n.pointCount && m.strataBytes == n.strataBytes &&
               m.attributeBytes == n.attributeBytes && m.offset == n.offset));
    }
}

std::unique_ptr<WorkFolder> openFolder(const std::string& path) {
    std::vector<std::string> warnings;
    auto folder = WorkFolder::open(path, "test", warnings);
    if (!folder)
        FAIL(folder.error().sentence());
    return std::move(folder).value();
}

Journal openJournal(WorkFolder& folder, bool reopen) {
    auto journal = Journal::open(folder, reopen);
    if (!journal)
        FAIL(journal.error().sentence());
    return std::move(journal).value();
}

void replace(const std::string& path, ByteSpan bytes) {
    std::filesystem::remove(path); // some file systems wait for the disk where a file is emptied
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

struct Loaded {
    std::optional<int> density;
    std::vector<BuiltSubtree> built;
};
Loaded load(WorkFolder& folder, ByteSpan bytes) {
    replace(folder.path() + "/journal", bytes);
    Journal journal = openJournal(folder, true);
    return {journal.density(), journal.takeBuilt()};
}

// A density and three small subtrees, and where each record ends.
struct Example {
    std::vector<BuiltSubtree> subtrees;
    Bytes bytes;
    std::vector<std::size_t> ends;

    explicit Example(WorkFolder& folder) {
        const std::string path = folder.path() + "/journal";
        Journal journal = openJournal(folder, false);
        REQUIRE(journal.setDensity(11).ok());
        ends.push_back(std::filesystem::file_size(path));
        for (std::size_t i = 0; i < 3; ++i) {
            subtrees.push_back(randomSubtree(i, i));
            REQUIRE(journal.add(subtrees[i]).ok());
            ends.push_back(std::filesystem::file_size(path));
        }
        bytes = fileBytes(path);
    }
    // Whether what was loaded is the first `records` records.
    void checkFirst(const Loaded& loaded, std::size_t records) const {
        CHECK(loaded.density.has_value() == (records > 0));
        REQUIRE(loaded.built.size() == (records > 0 ? records - 1 : 0));
        for (std::size_t i = 0; i < loaded.built.size(); ++i)
            checkSame(loaded.built[i], subtrees[i]);
    }
    std::size_t recordsBefore(std::size_t size) const {
        std::size_t records = 0;
        while (records < ends.size() && ends[records] <= size)
            ++records;
        return records;
    }
};
} // namespace

TEST_CASE("a journal gives back what was put into it", "[journal]") {
    TemporaryFolder folder;
    auto work = openFolder(folder / "work");
    std::vector<BuiltSubtree> subtrees;
    {
        Journal journal = openJournal(*work, false);
        CHECK_FALSE(journal.density().has_value());
        REQUIRE(journal.setDensity(9).ok());
        for (std::size_t i = 0; i < 5; ++i) {
            subtrees.push_back(randomSubtree(i, 20 * i));
            REQUIRE(journal.add(subtrees[i]).ok());
        }
    }
    Journal journal = openJournal(*work, true);
    CHECK(journal.density() == 9);
    auto built = journal.takeBuilt();
    REQUIRE(built.size() == subtrees.size());
    for (std::size_t i = 0; i < built.size(); ++i)
        checkSame(built[i], subtrees[i]);
    Journal fresh = openJournal(*work, false);
    CHECK(fresh.takeBuilt().empty());
    CHECK_FALSE(fresh.density().has_value());
}

TEST_CASE("a journal cut anywhere holds the records before the cut, and goes on", "[journal]") {
    TemporaryFolder folder;
    auto work = openFolder(folder / "work");
    Example example(*work);
    for (std::size_t size = 0; size <= example.bytes.size(); ++size) {
        INFO("cut after " << size << " bytes");
        std::size_t records = example.recordsBefore(size);
        example.checkFirst(load(*work, ByteSpan(example.bytes).first(size)), records);
    }
    replace(work->path() + "/journal", ByteSpan(example.bytes).first(example.ends[2] + 5));
    REQUIRE(openJournal(*work, true).add(example.subtrees[2]).ok());
    Journal journal = openJournal(*work, true);
    example.checkFirst({journal.density(), journal.takeBuilt()}, 4);
}

TEST_CASE("a journal with a damaged byte ends before the damage", "[journal]") {
    TemporaryFolder folder;
    auto work = openFolder(folder / "work");
    Example example(*work);
    for (std::size_t at = 0; at < example.bytes.size(); ++at)
        for (int change : {0x01, 0x80, 0xFF}) {
            INFO("byte " << at);
            Bytes damaged = example.bytes;
            damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ change);
            example.checkFirst(load(*work, damaged), example.recordsBefore(at));
        }
}

TEST_CASE("a record that could not be written is not in the way of later ones", "[journal]") {
    TemporaryFolder folder;
    auto work = openFolder(folder / "work");
    BuiltSubtree small = randomSubtree(1, 1), large = randomSubtree(2, 50);
    {
        Journal journal = openJournal(*work, false);
        REQUIRE(journal.setDensity(4).ok());
        {
            FileSizeLimit limit(200);
            Status refused = journal.add(large);
            REQUIRE_FALSE(refused.ok());
            CHECK(refused.error().code == ErrorCode::writeFailed);
        }
        REQUIRE(journal.add(small).ok());
    }
    Journal journal = openJournal(*work, true);
    auto built = journal.takeBuilt();
    REQUIRE(built.size() == 1);
    checkSame(built[0], small);
}
