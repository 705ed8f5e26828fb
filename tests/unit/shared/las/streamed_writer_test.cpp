// LAS into sinks that are no files: memory, and bytes that leave at once.
#include "shared/io/byte_sink.hpp"
#include "tests/unit/shared/las/las_bytes.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {

// Bytes on their way to someone.
class LeavingSink final : public ByteSink {
  public:
    LeavingSink(Bytes& to, bool& finished) : to_(to), finished_(finished) {}
    Status finish() override {
        finished_ = true;
        return {};
    }

  private:
    Status put(ByteSpan bytes) override {
        to_.insert(to_.end(), bytes.begin(), bytes.end());
        return {};
    }
    Bytes& to_;
    bool& finished_;
};

struct Recipe {
    las::WriterOptions options;
    PointBatch points;

    // `extra`: with an attribute that the header describes, and three bytes that it does not.
    explicit Recipe(int format, bool extra) {
        LasRecipe recipe{format <= 5 ? 3 : 4, format, 1000};
        recipe.extraBytes = extra ? 3 : 0;
        MemorySource source(lasBytes(recipe));
        auto reader = las::Reader::open(source);
        REQUIRE(reader.ok());
        options = las::optionsLike(**reader);
        options.versionMinor = -1;
        REQUIRE((*reader)->read(0, 1000, points).ok());
        if (!extra)
            return;
        options.schema.attributes.insert(options.schema.attributes.begin(), {"Height", AttributeType::u16});
        points.columns.insert(points.columns.begin(), Bytes());
        for (std::size_t i = 0; i < 2 * points.size(); ++i)
            points.columns[0].push_back(static_cast<std::uint8_t>(i * 31 % 251));
    }

    las::PointSummary summary() const {
        auto columns = las::summaryColumnsFor(options);
        REQUIRE(columns.ok());
        las::PointSummary summary;
        las::addToSummary(summary, *columns, options.schema, points);
        return summary;
    }
};

Bytes inMemory(const Recipe& recipe) {
    Bytes bytes;
    auto writer = las::Writer::create(std::make_unique<MemorySink>(bytes), recipe.options);
    REQUIRE(writer.ok());
    REQUIRE((*writer)->write(recipe.points).ok());
    REQUIRE((*writer)->finish().ok());
    return bytes;
}

} // namespace

TEST_CASE("memory takes the bytes of a file") {
    for (int format : {1, 7}) {
        Recipe recipe(format, true);
        for (bool compressed : {false, true}) {
            recipe.options.compressed = compressed;
            auto file = writeLas(recipe.options, recipe.points);
            REQUIRE(file.ok());
            CHECK((inMemory(recipe) == *file));
        }
    }
}

TEST_CASE("a sink that can't be overwritten takes the same bytes, if it is said what will come") {
    for (int format = 0; format <= 10; ++format) {
        Recipe recipe(format, format % 2 == 1);
        if (format == 8) // an extended record behind the points
            recipe.options.wkt = std::string(70000, 'w');
        Bytes bytes;
        bool finished = false;
        auto writer = las::Writer::create(std::make_unique<LeavingSink>(bytes, finished), recipe.options,
                                          recipe.summary());
        REQUIRE(writer.ok());
        CHECK((*writer)->header().pointCount == 1000);
        REQUIRE((*writer)->write(recipe.points).ok());
        REQUIRE((*writer)->finish().ok());
        CHECK(finished);
        INFO("format " << format);
        CHECK((bytes == inMemory(recipe)));
    }
}

TEST_CASE("no points are a file too") {
    Recipe recipe(6, true);
    recipe.points.resize(recipe.options.schema, 0);
    Bytes bytes;
    bool finished = false;
    auto writer =
        las::Writer::create(std::make_unique<LeavingSink>(bytes, finished), recipe.options, recipe.summary());
    REQUIRE(writer.ok());
    REQUIRE((*writer)->finish().ok());
    CHECK((bytes == inMemory(recipe)));
    CHECK(requireLas(bytes).points.size() == 0);
}

TEST_CASE("other points than were stated are no file") {
    Recipe recipe(7, true);
    las::PointSummary more = recipe.summary(), moved = more, returns = more, ranges = more;
    ++more.pointCount;
    --moved.bounds.min.x;
    ++returns.pointsByReturn[2];
    ++ranges.ranges.at(0).component[0].maxBits;
    for (const las::PointSummary& stated : {more, moved, returns, ranges}) {
        Bytes bytes;
        bool finished = false;
        auto writer =
            las::Writer::create(std::make_unique<LeavingSink>(bytes, finished), recipe.options, stated);
        REQUIRE(writer.ok());
        REQUIRE((*writer)->write(recipe.points).ok());
        CHECK((*writer)->finish().error().code == ErrorCode::corrupt);
        CHECK_FALSE(finished);
    }
}

TEST_CASE("what can't be written in one go is refused before the first byte") {
    Recipe recipe(7, true);
    Bytes bytes;
    bool finished = false;
    auto refusal = [&](std::optional<las::PointSummary> stated) {
        auto writer =
            las::Writer::create(std::make_unique<LeavingSink>(bytes, finished), recipe.options, stated);
        REQUIRE_FALSE(writer.ok());
        CHECK(writer.error().code == ErrorCode::invalidArgument);
        CHECK(bytes.empty());
        return writer.error().sentence();
    };
    CHECK(refusal(std::nullopt) ==
          "the header of a LAS file tells what its points are, and comes before them "
          "(summarize the points first, or write to a file)");
    las::PointSummary summary = recipe.summary();
    summary.ranges.clear();
    CHECK(refusal(summary).find("ranges of 0 extra attributes instead of ") != std::string::npos);
    recipe.options.compressed = true;
    CHECK(refusal(recipe.summary()).find("chunk table") != std::string::npos);
}
