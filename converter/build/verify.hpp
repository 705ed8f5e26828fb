// Whether a `.stipple` file is what it should be.
#pragma once

#include "converter/build/compare.hpp"
#include "converter/build/convert.hpp"

#include <optional>

namespace stipple {

struct VerifyReport {
    std::uint64_t fileBytes = 0, nodes = 0, points = 0;
    std::uint64_t spacedPoints = 0; // points of inner nodes, whose minimum distance was measured (poisson)
    std::uint64_t tooNear = 0;      // of these: nearer to one of their node than its spacing
    std::uint64_t faultCount = 0;
    std::vector<std::string> faults; // the first of them, one sentence each
    std::vector<std::string> warnings;
    std::optional<Comparison> comparison; // with the inputs, if any were given
    std::vector<std::string> attributeNames;

    bool passed() const { return faultCount == 0 && (!comparison || comparison->same()); }
};

// Reads the whole file: every block's checksum, every node decodes, counts agree, each point lies in its node
// and in the bounds, inner nodes keep their minimum distance (where they were sampled with one), statistics
// and hash are those of the metadata. With `inputs`, also that the file holds exactly their points (all in
// memory). `reading` must be as it was for the conversion: another grid step or other columns make other
// points.
//
// An error is returned where there is nothing to judge: no such file, no Stipple file, an input that can't be
// read. Everything else that is wrong is a fault in the report.
Result<VerifyReport> verifyFile(const std::string& path, const std::vector<std::string>& inputs, int threads,
                                const std::atomic<bool>* stop, const ConvertProgress& progress,
                                const InputOptions& reading = {});

} // namespace stipple
