// What we compress, another decoder reads back: laz-perf, which knows point formats 0-3 and 6-8.
#include "tests/unit/shared/las/laz/laz_bytes.hpp"

#include <cstdlib>

using namespace stipple;
using namespace stipple::test;

namespace {

void writeFile(const std::string& path, ByteSpan bytes) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    REQUIRE(file);
    REQUIRE(std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size());
    REQUIRE(std::fclose(file) == 0);
}

// The file by our writer, and the records that are in it.
void writeSample(const TemporaryFolder& folder, const LasRecipe& recipe, bool smooth) {
    const Bytes records =
        smooth ? smoothRecords(recipe.pointFormat, recipe.extraBytes, recipe.points) : randomRecords(recipe);
    LasContents las = requireLas(lasBytes(recipe, records));
    las::WriterOptions options;
    options.grid = las.header.grid;
    options.schema = las.schema;
    options.pointFormat = recipe.pointFormat;
    options.versionMinor = recipe.versionMinor;
    options.compressed = true;
    const std::string name = std::to_string(recipe.pointFormat) + "_" + std::to_string(recipe.extraBytes) +
                             "_" + std::to_string(recipe.points) + (smooth ? "_smooth" : "_random");
    auto writer = las::Writer::create(folder.file(name + ".laz"), options);
    REQUIRE(writer.ok());
    REQUIRE((*writer)->write(las.points).ok());
    REQUIRE((*writer)->finish().ok());
    writeFile(folder.file(name + ".records"), records);
}

} // namespace

TEST_CASE("laz-perf reads back what was written", "[laz]") {
    TemporaryFolder folder;
    for (int format : {0, 1, 2, 3, 6, 7, 8})
        for (std::size_t extra : {0u, 7u}) {
            LasRecipe recipe{format >= 6 ? 4 : 2, format, 3000, extra};
            writeSample(folder, recipe, true);
            writeSample(folder, recipe, false);
            recipe.points = 1;
            writeSample(folder, recipe, true);
            recipe.points = extra == 0 ? 100001 : 0; // three chunks, and none
            if (recipe.points > 0 || format < 6)     // laz-perf reads no layered file without points
                writeSample(folder, recipe, true);
        }
    const std::string command =
        std::string("node \"") + STIPPLE_SOURCE_DIR + "/tests/laz/read_back.mjs\" \"" + folder.path() + "\"";
    CHECK(std::system(command.c_str()) == 0);
}
