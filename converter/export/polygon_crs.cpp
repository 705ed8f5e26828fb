#include "converter/export/polygon_crs.hpp"

#include "converter/crs/proj_crs.hpp"
#include "shared/base/text.hpp"

namespace stipple {

namespace {

ProjObject horizontalOf(ProjObject crs, ProjContext& proj) {
    while (crs && (proj_get_type(crs.get()) == PJ_TYPE_COMPOUND_CRS ||
                   proj_get_type(crs.get()) == PJ_TYPE_BOUND_CRS)) {
        bool compound = proj_get_type(crs.get()) == PJ_TYPE_COMPOUND_CRS;
        crs = ProjObject{compound ? proj_crs_get_sub_crs(proj.get(), crs.get(), 0)
                                  : proj_get_source_crs(proj.get(), crs.get())};
    }
    return crs;
}

bool isSame(const ProjObject& a, const ProjObject& b, ProjContext& proj) {
    if (proj_is_equivalent_to_with_ctx(proj.get(), a.get(), b.get(),
                                       PJ_COMP_EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS))
        return true;
    // WKT 1 spells some parameters otherwise than PROJ's database does; the code decides then.
    std::optional<int> codeA = proj.describe(a).epsg, codeB = proj.describe(b).epsg;
    return codeA && codeA == codeB;
}

} // namespace

Status checkPolygonCrs(const Crs& cloud, const std::string& named, std::vector<std::string>& warnings) {
    if (named.empty())
        return {};
    if (!cloud.known()) {
        warnings.push_back(cat("the polygons are in ", named,
                               "; the cloud's CRS is not known, so they are taken to be in the same"));
        return {};
    }
    STIPPLE_TRY(proj, ProjContext::open());
    ProjObject theirs = horizontalOf(proj->fromText(named), *proj);
    ProjObject ours =
        horizontalOf(cloud.wkt.empty() ? proj->fromEpsg(*cloud.epsg) : proj->fromWkt(cloud.wkt), *proj);
    proj->takeMessages();
    std::string cloudName = cloud.epsg ? cat("EPSG:", *cloud.epsg) : cloud.name;
    if (!theirs || !ours) {
        warnings.push_back(cat("the polygons say they are in ", named,
                               ", which could not be compared with the cloud's ", cloudName,
                               "; they are taken to be in the same"));
        return {};
    }
    if (!isSame(ours, theirs, *proj))
        return Error{ErrorCode::invalidArgument,
                     cat("the polygons are in ", named, ", but the cloud is in ", cloudName), "crs",
                     "reproject the polygons to the cloud's CRS"};
    return {};
}

} // namespace stipple
