#include "client/region/point_taker.hpp"
#include "client/survey/directions.hpp"
#include "client/survey/picked_points.hpp"
#include "client/survey/volumes.hpp"
#include "shared/base/text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace stipple {

namespace {

using nlohmann::json;
using namespace survey;

// Points wait until it is known how many there are, where the size of the cells depends on that.
constexpr std::size_t maxPointsWaiting = 20'000'000;

Error wrong(Phrase what, Phrase advice = "") {
    return {ErrorCode::invalidArgument, std::move(what), "volume", std::move(advice)};
}

struct Setting {
    std::vector<GridPoint> corners;
    std::vector<Vec3d> local;       // of the corners, from the first
    std::vector<double> deviations; // of the base's supports
    Directions directions;
    std::optional<double> cell;
    Base base;
};

Result<Setting> settingFrom(const json& request) {
    if (!request.is_object())
        return wrong(say("an object {…} is expected"));
    STIPPLE_TRY(picked, pickedPointsFrom(request));
    if (picked.points.size() < 3)
        return wrong(say("a volume needs three corners at least"));
    std::vector<Vec3d> local = localPoints(picked.points);
    Vec3d origin = picked.points.front().grid.toWorld(picked.points.front().steps);
    bool geocentric = request.contains("geocentric") && request["geocentric"] == true;
    Directions directions = geocentric ? geocentricDirections(origin) : Directions{};
    auto level = [&](Vec3d at) { return Base::plane({at, directions.up}, directions); };
    std::vector<double> deviations = picked.deviations;
    Result<Base> base = wrong(say("'base' must be \"rim\", {\"height\": z} or {\"point\": {…}}"));
    const json stated = request.contains("base") ? request["base"] : json("rim");
    if (stated == "rim") {
        base = Base::rim(local, directions);
    } else if (stated.is_object() && stated.contains("height") && stated["height"].is_number()) {
        if (geocentric)
            return wrong(say("heights of Earth-centred coordinates can't be typed"),
                         say("pick a point of the base"));
        base = level({0, 0, stated["height"].get<double>() - origin.z});
        deviations = {0};
    } else if (stated.is_object() && stated.contains("point")) {
        STIPPLE_TRY(point, pickedPointsFrom(json{{"points", json::array({stated["point"]})}}));
        base = level(difference(point.points.front(), picked.points.front()));
        deviations = point.deviations;
    }
    if (!base.ok())
        return base.error();
    std::optional<double> cell;
    if (request.contains("cell") && !request["cell"].is_null()) {
        if (!request["cell"].is_number() || !(request["cell"].get<double>() > 0))
            return wrong(say("'cell' must be a number above 0"));
        cell = request["cell"].get<double>();
    }
    return Setting{std::move(picked.points), std::move(local), std::move(deviations), directions, cell,
                   std::move(*base)};
}

class VolumeTaker final : public PointTaker {
  public:
    VolumeTaker(Metadata metadata, Setting setting)
        : metadata_(std::move(metadata)), setting_(std::move(setting)) {}

    Status prepare() {
        for (Vec3d corner : setting_.local)
            plan_.push_back(setting_.directions.plan(corner));
        STIPPLE_CHECK(triangulate(plan_)); // says what is wrong before anything is read
        region_.emplace(std::vector<Polygon>{{Ring(plan_), {}}});
        return setting_.cell ? begin(*setting_.cell) : Status();
    }

    Status take(PointBatch batch) override {
        for (const Vec3i& position : batch.positions) {
            Vec3d local = difference({position, metadata_->grid}, setting_.corners.front());
            if (measure_)
                measure_->add(local);
            else if (region_->contains(setting_.directions.plan(local)))
                waiting_.push_back(local);
        }
        if (waiting_.size() > maxPointsWaiting)
            return Error{ErrorCode::limitExceeded,
                         say("the polygon holds more than ", maxPointsWaiting, " points"), "volume",
                         say("say how large the cells are, or draw a smaller one")};
        return {};
    }

    Result<json> finish() override {
        if (!measure_) {
            // Twice the distance that points have if they lie in squares.
            double area = std::abs(signedArea(plan_));
            double points = static_cast<double>(std::max<std::size_t>(waiting_.size(), 1));
            STIPPLE_CHECK(begin(2 * std::sqrt(area / points)));
            for (Vec3d local : waiting_)
                measure_->add(local);
            waiting_ = {};
        }
        STIPPLE_TRY(result, measure_->result());
        return answerOf(result);
    }

    const std::vector<int>& attributes() const override { return none_; }

  private:
    Status begin(double cell) {
        cell_ = cell;
        STIPPLE_TRY(measure, CutFillMeasure::make(setting_.local, setting_.base, cell, setting_.directions));
        measure_.emplace(std::move(measure));
        return {};
    }

    // What heights scatter by, and what the base may be off by.
    double deviation(double ofHeights, const std::vector<double>& cut,
                     const std::vector<double>& fill) const {
        double square = ofHeights * ofHeights;
        for (std::size_t i = 0; i < setting_.deviations.size(); ++i) {
            double share = (i < cut.size() ? cut[i] : 0) + (i < fill.size() ? fill[i] : 0);
            square += share * share * setting_.deviations[i] * setting_.deviations[i];
        }
        return std::sqrt(square);
    }

    json answerOf(const CutFill& result) const {
        return {{"kind", "volume"},
                {"cut", result.cut},
                {"±cut", deviation(result.cutDeviation, result.cutShares, {})},
                {"fill", result.fill},
                {"±fill", deviation(result.fillDeviation, {}, result.fillShares)},
                {"net", result.net()},
                {"±net", deviation(result.deviation, result.cutShares, result.fillShares)},
                {"area", result.area},
                {"areaWithoutPoints", result.areaWithoutPoints},
                {"pointsInside", result.points},
                {"cell", cell_}};
    }

    Metadata metadata_;
    Setting setting_;
    std::vector<Point2d> plan_;
    std::optional<PolygonRegion> region_; // in plan
    std::optional<CutFillMeasure> measure_;
    double cell_ = 0;
    std::vector<Vec3d> waiting_; // inside the polygon
    std::vector<int> none_;
};

json listOf(Vec3d v) {
    return {v.x, v.y, v.z};
}

} // namespace

Result<std::unique_ptr<PointTaker>> volumeTaker(const Metadata& metadata, const json& request) {
    STIPPLE_TRY(setting, settingFrom(request));
    auto taker = std::make_unique<VolumeTaker>(metadata, std::move(setting));
    STIPPLE_CHECK(taker->prepare());
    return std::unique_ptr<PointTaker>(std::move(taker));
}

Result<json> volumeRegion(const json& request) {
    STIPPLE_TRY(setting, settingFrom(request));
    auto worldOf = [](const GridPoint& p) { return p.grid.toWorld(p.steps); };
    if (!(request.contains("geocentric") && request["geocentric"] == true)) {
        json polygon = json::array();
        for (const GridPoint& corner : setting.corners)
            polygon.push_back({worldOf(corner).x, worldOf(corner).y});
        return json{{"polygon", std::move(polygon)}};
    }
    // A column along `up` around the polygon, higher than the Earth.
    const Directions& directions = setting.directions;
    BoxD plan;
    for (Vec3d corner : setting.local)
        plan.extend(Vec3d{directions.plan(corner).x, directions.plan(corner).y, 0});
    Vec3d middle = (plan.min + plan.max) * 0.5, half = (plan.max - plan.min) * 0.5;
    Vec3d centre =
        worldOf(setting.corners.front()) + directions.east() * middle.x + directions.north * middle.y;
    double slack = 1e-6 * (half.x + half.y);
    return json{{"box",
                 {{"centre", listOf(centre)},
                  {"halfSize", {half.x + slack, half.y + slack, 1e5}},
                  {"axes", {listOf(directions.east()), listOf(directions.north), listOf(directions.up)}}}}};
}

} // namespace stipple
