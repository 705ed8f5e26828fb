// How often each value of an attribute, or height, occurs among the points in view: what a person sets ranges
// and filters by. Counted from what is drawn: each drawn point whose place lies in the picture counts once,
// whether another covers it or not. Inner nodes' points stand for many in a coarse picture; a settled one has
// them all.
//
//   in view    0 <= x < width, 0 <= y < height of projectToPixels(grid.toWorld(integers)), in front of the
//   camera,
//              and not hidden by clips
//   counted    in view, and passed by every filter and hidden class of the style but those on the attribute
//   itself:
//              so the handles of a filter stand over all that it could show
//   bins       bin i of n holds range.min + [i, i + 1) × (range.max - range.min) / n; range.max is in the
//   last
//
// With continuous detail the points of each node's drawn prefix count. Values are the points' own; of inner
// nodes whose file shows means (InnerColour::mean), intensities and colours are those means until the exact
// ones are here: `coarse` says of how many points.
//
// Pure; any thread.
#pragma once

#include "client/core/clips.hpp"
#include "client/core/colour_style.hpp"
#include "client/core/frame_plan.hpp"
#include "client/core/node_columns.hpp"
#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stipple {

struct HistogramRequest {
    ColourMode mode = ColourMode::elevation; // elevation, or one that shows an attribute (attributeOf())
    std::string attribute;                   // of mode attribute
    std::size_t bins = 64;
    // Nothing: from the least to the greatest value in view. Attributes of whole numbers then have bins of
    // equally many of them, and `bins` is the most there are.
    std::optional<Range> range;
    friend bool operator==(const HistogramRequest&, const HistogramRequest&) = default;
};
inline constexpr std::size_t maxHistogramBins = 4096, maxHistogramRequests = 64;

struct Histogram {
    Range range;                                      // of the bins
    std::vector<std::uint64_t> bins;                  // empty if no point has a value
    std::uint64_t below = 0, above = 0;               // points with values outside of the range
    std::uint64_t points = 0;                         // with a value, in view
    std::uint64_t without = 0;                        // "no value", NaN, or of a cloud without the attribute
    std::uint64_t coarse = 0;                         // of `points`, those of which a mean was counted
    double min = 0, max = 0, mean = 0, deviation = 0; // of the values; 0 if there are none
};

struct ViewCounts {
    std::uint64_t points = 0;          // in view, whatever filters and classes hide
    std::uint64_t nodes = 0;           // drawn
    std::uint64_t nodesMissing = 0;    // of these, with attributes that are still on their way: not counted
    std::vector<Histogram> histograms; // in the order of the requests
};

// A drawn node with all that is here of it.
struct CountedNode {
    std::shared_ptr<const ResidentNode> node;
    std::vector<std::shared_ptr<const NodeColumns>> columns;
    std::uint32_t points = 0; // the drawn prefix
    bool isComplete = true;   // nothing that was asked for is still on its way
    bool isMean = false;      // its picture shows means, and exact colours or intensities are not here
    Vec3i corner;             // grid integers
    BoxD box;                 // that its points lie in, world units
    std::shared_ptr<const CloudMetadata> metadata;
};

// What a picture shows, held still while it is counted (ViewSession::countedView()).
struct CountedView {
    ViewTransform view;
    int width = 0, height = 0;
    ColourStyle style;
    Clips clips;
    std::vector<CountedNode> nodes;
};

// Counts bit by bit, so that a page stays responsive meanwhile.
class ViewCounter {
  public:
    ViewCounter(CountedView view, std::vector<HistogramRequest> requests);

    // Looks at about so many further points (at least a node). True once all are counted.
    bool advance(std::uint64_t points);
    const ViewCounts& counts() const { return counts_; } // complete after advance() said so

  private:
    // Whether a criterion of the style (a filter, the hidden classes) shows each point.
    struct Criterion {
        int attribute;
        std::vector<char> passes;
    };
    // Sums over the values, by Welford's recurrence (Technometrics 1962), which loses nothing to large means.
    struct Moments {
        double mean = 0, squares = 0;
    };

    void look(const CountedNode& node);
    std::vector<char> inView(const CountedNode& node) const;
    std::vector<Criterion> criteria(const CountedNode& node) const;
    std::vector<double> values(const CountedNode& node, const HistogramRequest& request) const;
    static int attributeOf(const CountedNode& node, const HistogramRequest& request);
    void count(const CountedNode& node, std::size_t at, const std::vector<double>& of,
               const std::vector<char>& visible, const std::vector<Criterion>& criteria);
    void startBins();
    static void setBins(Histogram& histogram, const HistogramRequest& request, bool isWhole);
    bool isWhole(const HistogramRequest& request) const;

    CountedView view_;
    std::vector<HistogramRequest> requests_;
    std::vector<Moments> moments_;
    ViewCounts counts_;
    std::size_t next_ = 0;     // node
    bool secondPass_ = false;  // ranges are known: bins are filled
    bool needsSecond_ = false; // a request leaves its range to the values
};

// The names of the attributes that the requests look at, without elevation.
std::vector<std::string> attributesOf(const std::vector<HistogramRequest>& requests);

// [{"colourMode": "intensity", "bins": 64, "range": null}, {"colourMode": "attribute", "attribute": "Scan
// Angle"}, …]
Result<std::vector<HistogramRequest>> histogramRequestsFromJson(std::string_view text);
// Fields as in the structs; a range is [min, max], or null without bins.
nlohmann::json toJson(const ViewCounts& counts);

} // namespace stipple
