#include "converter/crs/transformation.hpp"

#include "converter/crs/proj_crs.hpp"
#include "shared/base/text.hpp"

#include <proj_experimental.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <vector>

namespace stipple {

namespace {
struct ListDeleter {
    void operator()(PJ_OBJ_LIST* list) const { proj_list_destroy(list); }
};
using ProjList = std::unique_ptr<PJ_OBJ_LIST, ListDeleter>;
struct FactoryDeleter {
    void operator()(PJ_OPERATION_FACTORY_CONTEXT* context) const {
        proj_operation_factory_context_destroy(context);
    }
};
using ProjFactory = std::unique_ptr<PJ_OPERATION_FACTORY_CONTEXT, FactoryDeleter>;

Result<ProjObject> definitionOf(const Crs& crs, ProjContext& proj) {
    ProjObject object;
    if (!crs.wkt.empty())
        object = proj.fromWkt(crs.wkt);
    if (!object && crs.epsg)
        object = proj.fromEpsg(*crs.epsg);
    std::string messages = proj.takeMessages();
    if (!object)
        return Error{ErrorCode::unsupported, cat("PROJ does not understand its definition: ", messages),
                     crsTitle(crs), "name the system by its EPSG code"};
    return object;
}

// A system as it is without a transformation to WGS 84 bound to it.
ProjObject unbound(ProjContext& proj, const PJ* crs) {
    return ProjObject{proj_get_type(crs) == PJ_TYPE_BOUND_CRS ? proj_get_source_crs(proj.get(), crs)
                                                              : proj_clone(proj.get(), crs)};
}

bool isGeocentric(ProjContext& proj, const PJ* crs) {
    return proj_get_type(unbound(proj, crs).get()) == PJ_TYPE_GEOCENTRIC_CRS;
}

bool hasHeights(ProjContext& proj, const PJ* crs) {
    ProjObject plain = unbound(proj, crs);
    if (proj_get_type(plain.get()) == PJ_TYPE_COMPOUND_CRS)
        return true;
    ProjObject system{proj_crs_get_coordinate_system(proj.get(), plain.get())};
    return system && proj_cs_get_axis_count(proj.get(), system.get()) > 2;
}

ProjObject horizontalOf(ProjContext& proj, ProjObject crs) {
    ProjObject plain = unbound(proj, crs.get());
    ProjObject flat{proj_get_type(plain.get()) == PJ_TYPE_COMPOUND_CRS
                        ? proj_crs_get_sub_crs(proj.get(), plain.get(), 0)
                        : proj_crs_demote_to_2D(proj.get(), nullptr, plain.get())};
    return flat ? std::move(flat) : std::move(crs);
}

ProjObject withEllipsoidalHeights(ProjContext& proj, ProjObject crs) {
    ProjObject solid{proj_crs_promote_to_3D(proj.get(), nullptr, crs.get())};
    return solid ? std::move(solid) : std::move(crs);
}

// Makes both systems define heights, or neither. Answers whether neither does.
bool alignHeights(ProjContext& proj, ProjObject& from, ProjObject& to) {
    bool fromHas = hasHeights(proj, from.get()), toHas = hasHeights(proj, to.get());
    if (fromHas == toHas)
        return !fromHas;
    if (isGeocentric(proj, from.get()) || isGeocentric(proj, to.get())) {
        ProjObject& flat = fromHas ? to : from;
        flat = withEllipsoidalHeights(proj, std::move(flat));
        return false;
    }
    ProjObject& solid = fromHas ? from : to;
    solid = horizontalOf(proj, std::move(solid));
    return true;
}

// West, south, east, north in degrees of what lies in `area`; nothing where that can't be told.
std::optional<std::array<double, 4>> geographicArea(ProjContext& proj, const PJ* from, const BoxD& area) {
    if (area.empty())
        return std::nullopt;
    ProjObject plain = unbound(proj, from);
    ProjObject geodetic{proj_crs_get_geodetic_crs(proj.get(), plain.get())};
    if (!geodetic)
        return std::nullopt;
    // "CRS to geographic 2D of the same datum" is a mere conversion; its first operation is the only one.
    ProjObject flat = horizontalOf(proj, std::move(geodetic));
    if (!isGeocentric(proj, from))
        plain = horizontalOf(proj, std::move(plain));
    ProjObject conversion{
        proj_create_crs_to_crs_from_pj(proj.get(), plain.get(), flat.get(), nullptr, nullptr)};
    ProjObject eastFirst{conversion ? proj_normalize_for_visualization(proj.get(), conversion.get())
                                    : nullptr};
    if (!eastFirst)
        return std::nullopt;
    std::array<double, 4> degrees{180, 90, -180, -90};
    constexpr int pieces = 4;
    for (int i = 0; i <= pieces; ++i)
        for (int j = 0; j <= pieces; ++j) {
            auto at = [](double low, double high, int step) { return low + (high - low) * step / pieces; };
            PJ_COORD place = proj_trans(
                eastFirst.get(), PJ_FWD,
                proj_coord(at(area.min.x, area.max.x, i), at(area.min.y, area.max.y, j), area.min.z, 0));
            if (!(std::abs(place.xy.x) <= 180) || !(std::abs(place.xy.y) <= 90))
                return std::nullopt;
            degrees = {std::min(degrees[0], place.xy.x), std::min(degrees[1], place.xy.y),
                       std::max(degrees[2], place.xy.x), std::max(degrees[3], place.xy.y)};
        }
    return degrees;
}

// The best operation that can be carried out with what is installed, or null.
ProjObject bestOperation(ProjContext& proj, const PJ* from, const PJ* to,
                         const std::optional<std::array<double, 4>>& area) {
    ProjFactory factory{proj_create_operation_factory_context(proj.get(), nullptr)};
    proj_operation_factory_context_set_spatial_criterion(proj.get(), factory.get(),
                                                         PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
    proj_operation_factory_context_set_grid_availability_use(proj.get(), factory.get(),
                                                             PROJ_GRID_AVAILABILITY_USED_FOR_SORTING);
    if (area)
        proj_operation_factory_context_set_area_of_interest(proj.get(), factory.get(), (*area)[0], (*area)[1],
                                                            (*area)[2], (*area)[3]);
    ProjList operations{proj_create_operations(proj.get(), from, to, factory.get())};
    int count = operations ? proj_list_get_count(operations.get()) : 0;
    for (int i = 0; i < count; ++i) {
        ProjObject operation{proj_list_get(proj.get(), operations.get(), i)};
        if (operation && proj_coordoperation_is_instantiable(proj.get(), operation.get()))
            return operation;
    }
    return nullptr;
}

// Whether nothing but formulas is applied: no shift between datums that someone measured. PROJ states no
// accuracy of those.
bool isConversion(ProjContext& proj, const PJ* operation) {
    if (proj_get_type(operation) != PJ_TYPE_CONCATENATED_OPERATION)
        return proj_get_type(operation) == PJ_TYPE_CONVERSION;
    int count = proj_concatoperation_get_step_count(proj.get(), operation);
    for (int i = 0; i < count; ++i) {
        ProjObject step{proj_concatoperation_get_step(proj.get(), operation, i)};
        if (!step || proj_get_type(step.get()) != PJ_TYPE_CONVERSION)
            return false;
    }
    return true;
}

// A transformation in a context of its own, which one thread uses at a time.
class Runner {
  public:
    static Result<std::unique_ptr<Runner>> create(const PJ* operation) {
        std::unique_ptr<Runner> runner(new Runner);
        STIPPLE_TRY(context, ProjContext::open());
        runner->context_ = std::move(context);
        runner->operation_.reset(proj_clone(runner->context_->get(), operation));
        if (!runner->operation_)
            return Error{ErrorCode::ioFailed,
                         cat("PROJ could not set up the transformation: ", runner->context_->takeMessages()),
                         "", ""};
        // Each point that fails would be a message.
        proj_log_level(runner->context_->get(), PJ_LOG_NONE);
        return runner;
    }

    void transform(double* x, double* y, double* z, std::size_t count) {
        constexpr std::size_t stride = sizeof(double);
        std::size_t done = proj_trans_generic(operation_.get(), PJ_FWD, x, stride, count, y, stride, count, z,
                                              stride, count, nullptr, 0, 0);
        for (std::size_t i = 0; i < count; ++i)
            if (i >= done || !std::isfinite(x[i]) || !std::isfinite(y[i]) || !std::isfinite(z[i]))
                x[i] = y[i] = z[i] = HUGE_VAL;
    }

  private:
    Runner() = default;
    std::unique_ptr<ProjContext> context_;
    ProjObject operation_; // goes before its context
};

class Transformation final : public CrsTransformation {
  public:
    Status prepare(const Crs& from, const Crs& to, const BoxD& area) {
        STIPPLE_TRY(proj, ProjContext::open());
        proj_ = std::move(proj);
        STIPPLE_TRY(source, definitionOf(from, *proj_));
        STIPPLE_TRY(target, definitionOf(to, *proj_));
        facts_.keepsHeights = alignHeights(*proj_, source, target);
        auto degrees = geographicArea(*proj_, source.get(), area);
        proj_->takeMessages();
        ProjObject operation = bestOperation(*proj_, source.get(), target.get(), degrees);
        if (operation)
            operation_.reset(proj_normalize_for_visualization(proj_->get(), operation.get()));
        std::string messages = proj_->takeMessages();
        if (!operation_)
            return Error{ErrorCode::unsupported,
                         cat("PROJ knows no way to ", crsTitle(to), messages.empty() ? "" : ": ", messages),
                         crsTitle(from), "choose another --crs"};
        const char* name = proj_get_name(operation.get());
        facts_.operation = name ? name : "";
        double accuracy = proj_coordoperation_get_accuracy(proj_->get(), operation.get());
        if (accuracy >= 0)
            facts_.accuracyMeters = accuracy;
        else if (isConversion(*proj_, operation.get()))
            facts_.accuracyMeters = 0;
        facts_.isBallpark =
            proj_coordoperation_has_ballpark_transformation(proj_->get(), operation.get()) != 0;
        return {};
    }

    const Facts& facts() const override { return facts_; }
    Result<std::unique_ptr<CrsTransformer>> transformer() const override;

    void giveBack(std::unique_ptr<Runner> runner) const {
        std::lock_guard lock(mutex_);
        idle_.push_back(std::move(runner));
    }

  private:
    std::unique_ptr<ProjContext> proj_;
    ProjObject operation_;
    Facts facts_;
    mutable std::mutex mutex_; // of what follows, and of operation_ while it is cloned
    mutable std::vector<std::unique_ptr<Runner>> idle_;
};

class Lease final : public CrsTransformer {
  public:
    Lease(const Transformation& owner, std::unique_ptr<Runner> runner)
        : owner_(owner), runner_(std::move(runner)) {}
    ~Lease() override { owner_.giveBack(std::move(runner_)); }
    void transform(double* x, double* y, double* z, std::size_t count) override {
        runner_->transform(x, y, z, count);
    }

  private:
    const Transformation& owner_;
    std::unique_ptr<Runner> runner_;
};

Result<std::unique_ptr<CrsTransformer>> Transformation::transformer() const {
    std::unique_ptr<Runner> runner;
    {
        std::lock_guard lock(mutex_);
        if (!idle_.empty()) {
            runner = std::move(idle_.back());
            idle_.pop_back();
        } else {
            STIPPLE_TRY(created, Runner::create(operation_.get()));
            runner = std::move(created);
        }
    }
    return std::unique_ptr<CrsTransformer>(std::make_unique<Lease>(*this, std::move(runner)));
}
} // namespace

Result<std::shared_ptr<const CrsTransformation>> CrsTransformation::create(const Crs& from, const Crs& to,
                                                                           const BoxD& area) {
    auto transformation = std::make_shared<Transformation>();
    STIPPLE_CHECK(transformation->prepare(from, to, area));
    return std::shared_ptr<const CrsTransformation>(std::move(transformation));
}

std::string crsTitle(const Crs& crs) {
    std::string name = crs.name.empty() ? "an unnamed system" : crs.name;
    return crs.epsg ? cat(name, " (EPSG:", *crs.epsg, ")") : name;
}

} // namespace stipple
