// sampling_bench FILE.stipple...: how evenly the points of inner nodes lie. All distances are exact, measured
// as the converter does, and over the spacing of the level.
//
// "own" are the points of a level's inner nodes: how many have another one nearer than the spacing in their
// own node, and in another node of the level; the distance to the nearest of the level (least, 5 % quantile,
// mean). "drawn" are the points of a level's inner nodes and of those above: what a picture shows that ends
// with the level; the same distances, then holes: from points of leaves below the level (500,000 at most,
// evenly chosen) to the nearest point drawn (mean, 95 % quantile), and the mean distance over the mean hole,
// which does not depend on how many points there are: about 1 for random points of a plane.
#include "converter/build/spacing.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/file_source.hpp"
#include "tests/bench/kd_tree.hpp"

#include <cstdio>
#include <cstdlib>
#include <map>

namespace {

using namespace stipple;
using namespace stipple::bench;

constexpr std::size_t mostProbes = 500'000;

template <class T>
T need(Result<T> result) {
    if (!result.ok()) {
        std::fprintf(stderr, "%s\n", result.error().sentence().c_str());
        std::exit(1);
    }
    return std::move(result).value();
}

struct Distances {
    std::vector<double> values;

    double mean() const {
        double sum = 0;
        for (double v : values)
            sum += v;
        return values.empty() ? 0 : sum / static_cast<double>(values.size());
    }
    double quantile(double share) {
        if (values.empty())
            return 0;
        auto at =
            values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
        std::nth_element(values.begin(), at, values.end());
        return *at;
    }
};

struct Violations {
    std::size_t points = 0, inside = 0, across = 0; // points that have one too near
    void add(const Violations& other) {
        points += other.points;
        inside += other.inside;
        across += other.across;
    }
};

struct InnerPoint {
    Vec3i p;
    std::uint32_t node = 0;
};
struct LeafPoint {
    Vec3d at;
    int level = 0;
};

class Cloud {
  public:
    explicit Cloud(const char* path) : source_(need(openFileSource(path))) {
        reader_ = need(CloudReader::open(*source_));
        metric_ = distanceMetric(metadata().grid, metadata().crs);
        std::uint32_t node = 0;
        Status visited = reader_->visitNodes([&](const NodeEntry& entry) -> Status {
            STIPPLE_TRY(batch, reader_->readNode(entry));
            ++node;
            if (entry.childMask != 0)
                innerNodes_[entry.key.level].insert(entry.key);
            for (Vec3i p : batch.positions)
                if (entry.childMask != 0)
                    levels_[entry.key.level].push_back({p, node});
                else
                    leaves_.push_back({measured(p), entry.key.level});
            return {};
        });
        if (!visited.ok()) {
            std::fprintf(stderr, "%s\n", visited.error().sentence().c_str());
            std::exit(1);
        }
    }

    void print() {
        std::printf("%s: %s, %zu points in leaves\n", metadata().name.c_str(),
                    samplingNames[static_cast<std::size_t>(metadata().sampling)], leaves_.size());
        std::printf("        |                        own                            |"
                    "                      drawn\n");
        std::printf("  level |    points  %%inside  %%across    least     5%%     mean |"
                    "    points     5%%     mean     hole    95%%  mean/hole\n");
        Violations violations;
        Distances nearest;
        for (const auto& [level, points] : levels_)
            printLevel(level, points, violations, nearest);
        auto count = static_cast<double>(violations.points);
        double least = nearest.quantile(0), low = nearest.quantile(0.05);
        std::printf("    all | %9zu %8.4f %8.4f %8.4f %6.3f %8.3f |   (%zu inside, %zu across)\n\n",
                    violations.points, 100 * static_cast<double>(violations.inside) / count,
                    100 * static_cast<double>(violations.across) / count, least, low, nearest.mean(),
                    violations.inside, violations.across);
    }

  private:
    const CloudMetadata& metadata() const { return reader_->metadata(); }

    // In weighted steps from the root cube's corner.
    Vec3d measured(Vec3i p) const {
        Vec3i in = p - metadata().rootCube.min;
        return {static_cast<double>(in.x) * metric_.weights.x, static_cast<double>(in.y) * metric_.weights.y,
                static_cast<double>(in.z) * metric_.weights.z};
    }
    double spacing(int level) const { return std::ldexp(metadata().spacing, -level) / metric_.unit; }

    void printLevel(int level, const std::vector<InnerPoint>& points, Violations& all,
                    Distances& allNearest) {
        Violations violations;
        Distances own = ownDistances(level, points, violations);
        all.add(violations);
        allNearest.values.insert(allNearest.values.end(), own.values.begin(), own.values.end());
        auto count = static_cast<double>(std::max<std::size_t>(1, violations.points));
        double least = own.quantile(0), low = own.quantile(0.05);
        std::printf("  %5d | %9zu %8.4f %8.4f %8.4f %6.3f %8.3f |", level, violations.points,
                    100 * static_cast<double>(violations.inside) / count,
                    100 * static_cast<double>(violations.across) / count, least, low, own.mean());
        auto [drawn, holes] = drawnDistances(level);
        double drawnLow = drawn.quantile(0.05), far = holes.quantile(0.95);
        std::printf(" %9zu %6.3f %8.3f %8.3f %6.3f %10.3f\n", drawn.values.size(), drawnLow, drawn.mean(),
                    holes.mean(), far, holes.mean() > 0 ? drawn.mean() / holes.mean() : 0.0);
        std::fflush(stdout);
    }

    Distances ownDistances(int level, const std::vector<InnerPoint>& points, Violations& violations) const {
        constexpr double rounding = 1 - 1e-9;
        std::vector<TreePoint> measuredPoints;
        for (const InnerPoint& point : points)
            measuredPoints.push_back({measured(point.p), point.node});
        KdTree tree(std::move(measuredPoints));
        double least = spacing(level), tooNear = least * least * rounding;
        Distances nearest;
        for (std::size_t i = 0; i < tree.points().size(); ++i) {
            const TreePoint& point = tree.points()[i];
            bool inside = false, across = false;
            tree.around(point.at, tooNear, [&](std::size_t other, double squared) {
                if (other == i || squared >= tooNear)
                    return;
                (tree.points()[other].node == point.node ? inside : across) = true;
            });
            violations.inside += inside;
            violations.across += across;
            double squared = tree.squaredToNearest(point.at, i);
            if (std::isfinite(squared))
                nearest.values.push_back(std::sqrt(squared) / least);
        }
        violations.points += points.size();
        return nearest;
    }

    // Points whose place the level's inner nodes cover, and holes.
    std::pair<Distances, Distances> drawnDistances(int level) const {
        const NodeKeys& nodes = innerNodes_.at(level);
        std::vector<TreePoint> points;
        for (const auto& [above, some] : levels_)
            for (const InnerPoint& point : some)
                if (above <= level) {
                    bool covered = nodes.contains(metadata().rootCube.keyOf(point.p, level));
                    points.push_back({measured(point.p), covered ? 1u : 0u});
                }
        KdTree tree(std::move(points));
        Distances drawn, holes;
        for (std::size_t i = 0; i < tree.points().size(); ++i)
            if (const TreePoint& point = tree.points()[i]; point.node == 1)
                if (double squared = tree.squaredToNearest(point.at, i); std::isfinite(squared))
                    drawn.values.push_back(std::sqrt(squared) / spacing(level));
        std::size_t step = leaves_.size() / mostProbes + 1;
        for (std::size_t i = 0; i < leaves_.size(); i += step)
            if (leaves_[i].level > level)
                holes.values.push_back(std::sqrt(tree.squaredToNearest(leaves_[i].at)) / spacing(level));
        return {std::move(drawn), std::move(holes)};
    }

    std::unique_ptr<ByteSource> source_;
    std::unique_ptr<CloudReader> reader_;
    DistanceMetric metric_;
    std::map<int, std::vector<InnerPoint>> levels_; // of inner nodes
    std::map<int, NodeKeys> innerNodes_;
    std::vector<LeafPoint> leaves_;
};

} // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fprintf(stderr, "usage: sampling_bench FILE.stipple...\n");
        return 2;
    }
    for (int i = 1; i < argc; ++i)
        Cloud(argv[i]).print();
    return 0;
}
