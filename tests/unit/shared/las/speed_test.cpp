// How fast records are read and written, one thread. Hidden: run with `test_las "[bench]"`.
#include "tests/unit/shared/las/las_bytes.hpp"

#include <chrono>

using namespace stipple;
using namespace stipple::test;

namespace {

template <class Work>
double bestSeconds(int repetitions, const Work& work) {
    double best = 1e9;
    for (int i = 0; i < repetitions; ++i) {
        auto start = std::chrono::steady_clock::now();
        work();
        best =
            std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
}

} // namespace

TEST_CASE("million points a second that are read from memory and written to a file", "[.][bench]") {
    constexpr std::size_t points = 2'000'000, batchPoints = 65536;
    for (int format : {0, 1, 2, 3, 6, 7, 10}) {
        LasRecipe recipe{format >= 6 ? 4 : format >= 4 ? 3 : 2, format, points};
        MemorySource source(lasBytes(recipe));
        auto reader = las::Reader::open(source);
        REQUIRE(reader.ok());
        PointBatch batch;
        double read = bestSeconds(5, [&] {
            for (std::size_t first = 0; first < points; first += batchPoints)
                REQUIRE((*reader)->read(first, batchPoints, batch).ok());
        });
        REQUIRE((*reader)->read(0, batchPoints, batch).ok());
        TemporaryFolder folder;
        double write = bestSeconds(3, [&] {
            auto writer = las::Writer::create(folder.file("out.las"), las::optionsLike(**reader));
            REQUIRE(writer.ok());
            for (std::size_t first = 0; first < points; first += batchPoints)
                REQUIRE((*writer)->write(batch).ok());
            REQUIRE((*writer)->finish().ok());
        });
        std::printf("format %2d: read %6.1f M points/s, write %6.1f M points/s\n", format,
                    points / 1e6 / read, points / 1e6 / write);
    }
}
