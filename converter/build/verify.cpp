#include "converter/build/verify.hpp"

#include "converter/build/compare_inputs.hpp"
#include "converter/build/memory_share.hpp"
#include "converter/build/node_checks.hpp"
#include "converter/parallel/parallel.hpp"
#include "shared/base/text.hpp"

#include <filesystem>
#include <mutex>
#include <new>
#include <unistd.h>

namespace stipple {

namespace fs = std::filesystem;

namespace {
// Beside the file, where there was room for it; or where programs put such files.
std::string temporaryFolder(const std::string& path, const std::string& wanted) {
    if (!wanted.empty())
        return wanted;
    std::string beside = fs::path(path).parent_path().string();
    if (beside.empty())
        beside = ".";
    std::error_code failed;
    return ::access(beside.c_str(), W_OK) == 0 ? beside : fs::temp_directory_path(failed).string();
}

std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names)
        text += cat(text.empty() ? "" : ", ", name);
    return text;
}

class Verification {
  public:
    Verification(const std::string& path, const VerifyOptions& options, const ConvertProgress& progress)
        : path_(path), options_(options), threads_(threadCount(options.threads)), progress_(progress) {}

    Result<VerifyReport> run(const std::vector<std::string>& inputs) {
        STIPPLE_TRY(checks, NodeChecks::open(path_, threads_, faults_));
        checks_ = std::move(checks);
        for (const Attribute& attribute : checks_->metadata().schema.attributes)
            report_.attributeNames.push_back(attribute.name);
        report_.fileBytes = checks_->fileBytes();
        entries_ = checks_->listNodes();
        report_.nodes = entries_.size();
        if (faults_.count() == 0) {
            STIPPLE_CHECK(inputs.empty() ? checkNodes() : compareWith(inputs));
            NodeChecks::Sums sums = checks_->checkWhole();
            report_.points = sums.points;
            report_.spacedPoints = sums.spacedPoints;
            report_.tooNear = sums.tooNear;
            if (!nodesRead_) // what was compared is not what the file should hold
                report_.comparison.reset();
        }
        report_.faultCount = faults_.count();
        report_.faults = faults_.first();
        return std::move(report_);
    }

  private:
    Result<const PointBatch*> readNode(const NodeEntry& entry, int worker) {
        const PointBatch* batch = checks_->check(entry, worker);
        if (!batch)
            nodesRead_ = false;
        return batch;
    }

    Status checkNodes() {
        std::mutex mutex;
        std::uint64_t done = 0;
        return parallelFor(entries_.size(), threads_, options_.stop,
                           [&](std::size_t i, int worker) -> Status {
                               STIPPLE_CHECK(readNode(entries_[i], worker));
                               std::lock_guard lock(mutex);
                               done += entries_[i].pointCount;
                               progress_("verify", done, checks_->metadata().pointCount);
                               return {};
                           });
    }

    Status compareWith(const std::vector<std::string>& inputs) {
        const CloudMetadata& metadata = checks_->metadata();
        ScanOptions scanning;
        scanning.input = options_.reading;
        scanning.input.stop = options_.stop;
        scanning.input.threads = threads_;
        if (metadata.crs.known())
            scanning.target = metadata.crs; // as they were reprojected for the file
        STIPPLE_TRY(scan, scanInputs(inputs, scanning));
        const std::vector<UnmatchedAttribute> unmatched = mapOnto(scan, metadata.grid, metadata.schema);
        FileNodes nodes{metadata, entries_,
                        [this](const NodeEntry& entry, int worker) { return readNode(entry, worker); }};
        CompareOptions comparing{threads_, memoryForPoints(options_.memoryBytes),
                                 temporaryFolder(path_, options_.temp), options_.stop,
                                 options_.temporaryBytes};
        STIPPLE_TRY(compared, compareWithInputs(scan, unmatched, nodes, comparing, progress_));
        if (compared.sums.maxGridError > 0)
            report_.warnings.push_back(
                cat("compared on the file's grid, which holds the inputs' positions to within ",
                    compared.sums.maxGridError));
        judgeUnmatched(unmatched, compared.unmatchedHoldValues);
        noteUnsourced(scan);
        report_.comparison = std::move(compared.comparison);
        return {};
    }

    // What the inputs have and the file has not.
    void judgeUnmatched(const std::vector<UnmatchedAttribute>& unmatched,
                        const std::vector<std::uint8_t>& holdValues) {
        std::vector<std::string> empty;
        for (std::size_t u = 0; u < unmatched.size(); ++u) {
            if (unmatched[u].imposed && !holdValues[u])
                empty.push_back(unmatched[u].name);
            else if (unmatched[u].imposed)
                faults_.add(cat("the inputs' attribute ", unmatched[u].name,
                                " holds values, but is missing in the file"));
            else
                faults_.add(cat("the inputs' attribute ", unmatched[u].name,
                                " is missing or of another type in the file"));
        }
        if (!empty.empty())
            report_.notes.push_back(
                cat("the inputs hold nothing but 0 in fields that their format can't leave "
                    "out, and that the file does not have: ",
                    listed(empty)));
    }

    // What the file has and no input has.
    void noteUnsourced(const Scan& scan) {
        std::vector<std::string> names;
        for (std::size_t a = 0; a < scan.schema.attributes.size(); ++a) {
            bool found = false;
            for (const ScannedInput& input : scan.inputs)
                found = found || input.attributeSources[a] >= 0;
            if (!found)
                names.push_back(scan.schema.attributes[a].name);
        }
        if (!names.empty())
            report_.notes.push_back(
                cat("the inputs do not have these attributes of the file, which were compared with 0: ",
                    listed(names)));
    }

    const std::string& path_;
    const VerifyOptions& options_;
    const int threads_;
    const ConvertProgress& progress_;
    FaultList faults_;
    std::unique_ptr<NodeChecks> checks_;
    std::vector<NodeEntry> entries_;
    std::atomic<bool> nodesRead_{true};
    VerifyReport report_;
};
} // namespace

Result<VerifyReport> verifyFile(const std::string& path, const std::vector<std::string>& inputs,
                                const VerifyOptions& options, const ConvertProgress& progress) {
    try {
        return Verification(path, options, progress).run(inputs);
    } catch (const std::bad_alloc&) {
        return outOfMemory();
    }
}

} // namespace stipple
