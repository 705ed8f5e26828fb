// Scans a procedural scene into a LAS 1.4 file, point format 7.
//
// Exactly `points` points are written: every source (strip, station) has a share of them and is cut when it
// has delivered it; a source that has too few pulses goes over its pattern again. The town and the terrain
// grow with the cube root of the number of points, so do the distances between points shrink; see sideFor().
// Same options, same bytes, for any number of threads. Memory does not depend on `points` but through the
// size of the scene, which is bounded: 220 MB at most.
#pragma once

#include "converter/synth/scene.hpp"
#include "converter/synth/survey.hpp"
#include "shared/base/result.hpp"
#include "shared/geometry/grid.hpp"
#include "shared/points/point_batch.hpp"

#include <functional>
#include <string>

namespace stipple::synth {

struct SynthOptions {
    std::uint64_t points = 0;
    SceneKind scene = SceneKind::town;
    std::uint64_t seed = 1;
    unsigned threads = 1;
    double noiseMeters = 0.01; // deviation of the range error
    bool normals = false;      // NormalX, NormalY, NormalZ (float32) of the surfaces, towards the scanner
};

struct SynthReport {
    std::uint64_t points = 0;
    std::size_t strips = 0, stations = 0;
    double sideMeters = 0;
    std::size_t sceneObjects = 0, scenePrimitives = 0;
};

// Side of the square for so many points: town 400 m at 5 million (300 to 1,600 m), terrain 700 m at 5 million
// (400 to 4,000 m), both by the cube root; indoors fixed.
double sideFor(SceneKind kind, std::uint64_t points);

// What the scan's coordinates are in: scale 1 mm, offset at the scene's origin.
Grid gridOf(const Scene& scene);
// The CRS of the scene's world coordinates: WGS 84 / UTM zone 32N as WKT 1.
const std::string& crsWkt();
// Attributes of the points: LAS point format 7, and normals in extra bytes where they are wanted.
Schema scanSchema(bool normals = false);

// Takes the points in order, a batch at a time.
using PointSink = std::function<Status(const PointBatch&)>;
using ProgressSink = std::function<void(std::uint64_t done, std::uint64_t total)>;

// Scans `scene` into `sink`.
Result<SynthReport> scanScene(const Scene& scene, const SynthOptions& options, const PointSink& sink,
                              const ProgressSink& progress);

// Makes the scene, scans it, writes the file.
Result<SynthReport> synthesize(const std::string& path, const SynthOptions& options,
                               const ProgressSink& progress);

} // namespace stipple::synth
