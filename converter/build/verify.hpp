// Whether a `.stipple` file is what it should be.
#pragma once

#include "converter/build/compare.hpp"
#include "converter/build/convert.hpp"

#include <optional>

namespace stipple {

struct VerifyOptions {
    int threads = 0;               // 0: one for each core
    std::uint64_t memoryBytes = 0; // for points of a comparison, as in ConvertOptions
    std::string temp = {};         // folder for what does not fit; empty: the file's, or the system's
    InputOptions reading = {};     // as it was for the conversion: another grid step makes other points
    const std::atomic<bool>* stop = nullptr;
    std::atomic<std::uint64_t>* temporaryBytes = nullptr; // kept up to date, for a display
};

struct VerifyReport {
    std::uint64_t fileBytes = 0, nodes = 0, points = 0;
    std::uint64_t spacedPoints = 0; // points of inner nodes, whose minimum distance was measured (poisson)
    std::uint64_t tooNear = 0;      // of these: nearer to one of their node than its spacing
    std::uint64_t faultCount = 0;
    std::vector<std::string> faults; // the first of them, one sentence each
    std::vector<std::string> warnings;
    std::vector<std::string> notes;       // differences that are none, one sentence each
    std::optional<Comparison> comparison; // with the inputs, if any were given and all nodes can be read
    std::vector<std::string> attributeNames;

    bool passed() const { return faultCount == 0 && (!comparison || comparison->same()); }
};

// Reads the whole file once: all that node_checks.hpp looks for. With `inputs`, also that the file holds
// exactly their points, every attribute equal. Attributes that only one side has are equal where they are 0
// throughout: in the file where the inputs lack them, in the inputs if their format can't leave them out (the
// fields of a LAS point format); all others are a difference.
//
// An error is returned where there is nothing to judge: no such file, no Stipple file, an input that can't be
// read, no room for points. Everything else that is wrong is a fault in the report.
Result<VerifyReport> verifyFile(const std::string& path, const std::vector<std::string>& inputs,
                                const VerifyOptions& options, const ConvertProgress& progress);

} // namespace stipple
