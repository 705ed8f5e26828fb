// A small `.stipple` file made in memory, with points at random places of every node of a flat octree (each
// node has the four lower children), for tests of readers.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/format/node_entry.hpp"

#include <vector>

namespace stipple::test {

struct SmallCloudOptions {
    int levels = 3; // 1, 5, 21, 85, ... nodes
    std::uint32_t pointsPerNode = 400;
    Grid grid{};
    RootCube rootCube{{0, 0, 0}, 17};
    PictureColour colour = PictureColour::rgb;
    // mean: nodes with children show colours that are not their points'.
    InnerColour innerColour = InnerColour::exact;
    bool withIntensity = true;
    bool withNormals = false; // nx, ny, nz, int16
    bool withClasses = false; // Classification, of 0 to 255
    std::uint32_t seed = 1;
};

struct SmallCloud {
    CloudMetadata metadata;
    Bytes file;
    std::vector<NodeEntry> nodes; // in the order of the hierarchy
};

// A failed test if the file can't be made.
SmallCloud makeSmallCloud(const SmallCloudOptions& options = {});

} // namespace stipple::test
