// What is read and written again is the same, bit for bit, for every point format and version.
#include "tests/unit/shared/las/las_bytes.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {

struct Case {
    int versionMinor, pointFormat;
};

// Every version with every point format it defines.
std::vector<Case> allCases() {
    std::vector<Case> cases;
    for (int minor = 0; minor <= 4; ++minor)
        for (int format = 0; format <= las::highestPointFormat(minor); ++format)
            cases.push_back({minor, format});
    return cases;
}

} // namespace

TEST_CASE("random records of every format and version survive a round trip bit for bit") {
    for (Case c : allCases())
        for (std::size_t points : {0u, 1u, 1000u}) {
            CAPTURE(c.versionMinor, c.pointFormat, points);
            LasRecipe recipe{c.versionMinor, c.pointFormat, points};
            recipe.seed = static_cast<std::uint32_t>(100 * c.versionMinor + c.pointFormat);
            requireRoundTrip(lasBytes(recipe));
        }
}

TEST_CASE("undescribed extra bytes survive a round trip, also when there are many") {
    for (std::size_t extra : {1u, 7u, 255u, 256u, 1000u}) {
        CAPTURE(extra);
        LasRecipe recipe{4, 6, 20};
        recipe.extraBytes = extra;
        requireRoundTrip(lasBytes(recipe));
    }
}
