// What is left of a subtree when it has been sampled and packed, and the journal that remembers it.
#pragma once

#include "converter/build/sample.hpp"
#include "converter/build/statistics.hpp"
#include "converter/build/work_folder.hpp"
#include "shared/format/cloud_writer.hpp"
#include "shared/format/point_hash.hpp"

#include <optional>

namespace stipple {

struct BuiltSubtree {
    int tier = 0; // see build.hpp
    NodeKey key;
    std::uint64_t points = 0; // packed: in `nodes`
    PointHash hash;           // of those
    BatchStatistics statistics;
    std::vector<StoredNode> nodes;
    // The sample of the root, which the tier above takes up: rows in the scratch file.
    std::uint64_t sampleOffset = 0, samplePoints = 0;
    Borders borders;
};

// An append-only list of subtrees in the work folder. A record counts only when it is whole, so a journal can
// be cut anywhere. Thread: one at a time.
class Journal {
  public:
    // Takes up what an earlier run left if `reopen`, else starts a new one.
    static Result<Journal> open(WorkFolder& folder, bool reopen);

    // The spacing's density, which has to be the same in every run; unknown at first.
    std::optional<int> density() const { return density_; }
    Status setDensity(int density);

    // Those of earlier runs; left to the caller.
    std::vector<BuiltSubtree> takeBuilt() { return std::move(built_); }
    Status add(const BuiltSubtree& subtree);

  private:
    explicit Journal(std::unique_ptr<ScratchFile> file) : file_(std::move(file)) {}
    Status load();
    Status append(ByteSpan record);

    std::unique_ptr<ScratchFile> file_;
    std::optional<int> density_;
    std::vector<BuiltSubtree> built_;
};

} // namespace stipple
