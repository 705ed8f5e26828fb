#include "converter/build/known_sources.hpp"

#include "converter/parallel/parallel.hpp"
#include "shared/base/text.hpp"

#include <map>
#include <mutex>
#include <tuple>

namespace stipple {

namespace {
// What an input consists of: a scan of itself; a cloud of itself and of what it was made of.
std::vector<SourceFile> holdingsOf(const InputDescription& input) {
    std::vector<SourceFile> holdings{input.source};
    holdings.insert(holdings.end(), input.madeOf.begin(), input.madeOf.end());
    return holdings;
}

bool isCloud(const InputDescription& input) {
    return !input.madeOf.empty() || !input.source.pointHash.empty();
}

bool isSame(const SourceFile& a, const SourceFile& b) {
    if (a.pointCount == 0 || a.pointCount != b.pointCount)
        return false;
    if (!a.pointHash.empty() && !b.pointHash.empty())
        return a.pointHash == b.pointHash;
    return std::tie(a.name, a.format, a.sizeBytes) == std::tie(b.name, b.format, b.sizeBytes);
}

Result<PointHash> hashOfPoints(const PointInput& input, const KnownSourcesOptions& options) {
    std::mutex mutex;
    PointHash sum;
    auto hashPart = [&](std::size_t part, int) -> Status {
        STIPPLE_TRY(stream, input.openPart(part));
        PointHash own;
        for (PointBatch batch;;) {
            STIPPLE_CHECK(stream->next(batch));
            if (batch.size() == 0)
                break;
            own.add(input.description().schema, batch);
        }
        std::lock_guard lock(mutex);
        sum.add(own);
        return {};
    };
    STIPPLE_CHECK(parallelFor(input.parts().size(), options.threads, options.stop, hashPart));
    return sum;
}

class KnownSources {
  public:
    KnownSources(const Scan& scan, const KnownSourcesOptions& options) : scan_(scan), options_(options) {}

    Status refuse() {
        for (std::size_t i = 0; i < scan_.inputs.size(); ++i)
            for (std::size_t holder = 0; holder < scan_.inputs.size(); ++holder)
                if (i != holder && isCloud(input(holder)) && input(i).path != options_.append)
                    STIPPLE_CHECK(refuseHeld(i, input(holder)));
        return {};
    }

  private:
    const InputDescription& input(std::size_t i) const { return scan_.inputs[i].description(); }

    Status refuseHeld(std::size_t i, const InputDescription& holder) {
        std::vector<SourceFile> own = holdingsOf(input(i));
        for (const SourceFile& held : holdingsOf(holder)) {
            if (!held.pointHash.empty() && held.pointCount == own[0].pointCount && held.pointCount > 0) {
                STIPPLE_TRY(hash, hashOf(i));
                own[0].pointHash = hash;
            }
            for (const SourceFile& mine : own)
                if (isSame(mine, held))
                    return Error{ErrorCode::invalidArgument, textFor(mine, i, held, holder), input(i).path,
                                 "leave it out; --allow-duplicates adds the points once more"};
        }
        return {};
    }

    std::string textFor(const SourceFile& mine, std::size_t i, const SourceFile& held,
                        const InputDescription& holder) const {
        const bool isPart = mine.name != input(i).source.name;
        return cat(isPart ? cat("the points of ", mine.name, ", which it was made of,") : "its points",
                   " are in ", holder.path, " already",
                   held.name == holder.source.name || held.name == mine.name ? "" : cat(", as ", held.name));
    }

    // A cloud states its own.
    Result<std::string> hashOf(std::size_t i) {
        if (const std::string& stated = input(i).source.pointHash; !stated.empty())
            return stated;
        std::string& known = hashes_[i];
        if (known.empty()) {
            STIPPLE_TRY(hash, hashOfPoints(*scan_.inputs[i].input, options_));
            known = hash.hex();
        }
        return known;
    }

    const Scan& scan_;
    const KnownSourcesOptions& options_;
    std::map<std::size_t, std::string> hashes_; // of inputs that had to be read
};
} // namespace

Status refuseKnownSources(const Scan& scan, const KnownSourcesOptions& options) {
    return KnownSources(scan, options).refuse();
}

std::vector<std::string> equalInputs(const Scan& scan, const PointSums& sums) {
    std::vector<std::string> sentences;
    std::map<std::string, std::size_t> first;
    for (std::size_t i = 0; i < scan.inputs.size(); ++i) {
        if (sums.inputBounds[i].empty())
            continue;
        auto [known, isNew] = first.emplace(sums.inputHashes[i].hex(), i);
        if (!isNew)
            sentences.push_back(cat(scan.inputs[i].description().path, ": holds the same points as ",
                                    scan.inputs[known->second].description().path,
                                    "; they are in the cloud twice"));
    }
    return sentences;
}

} // namespace stipple
