#include "converter/crs/proj_crs.hpp"

#include <cstdlib>
#include <utility>

namespace stipple {

namespace {

void keepMessage(void* to, int, const char* message) {
    auto& messages = *static_cast<std::string*>(to);
    if (!messages.empty())
        messages += "; ";
    messages += message;
}

std::optional<int> epsgCode(const PJ* crs) {
    const char* authority = proj_get_id_auth_name(crs, 0);
    const char* code = proj_get_id_code(crs, 0);
    if (!authority || !code || std::string(authority) != "EPSG")
        return std::nullopt;
    char* end = nullptr;
    long number = std::strtol(code, &end, 10);
    if (*end != 0 || number <= 0 || number > 1'000'000)
        return std::nullopt;
    return static_cast<int>(number);
}

// The code of a CRS that bears none, if PROJ's database holds the same one: "certain, though the names
// differ" is its confidence 90.
std::optional<int> identifiedCode(PJ_CONTEXT* context, const PJ* crs) {
    int* confidence = nullptr;
    PJ_OBJ_LIST* matches = proj_identify(context, crs, "EPSG", nullptr, &confidence);
    std::optional<int> code;
    constexpr int certain = 90;
    if (matches && confidence && proj_list_get_count(matches) > 0 && confidence[0] >= certain)
        if (ProjObject match{proj_list_get(context, matches, 0)})
            code = epsgCode(match.get());
    proj_int_list_destroy(confidence);
    proj_list_destroy(matches);
    return code;
}

void describeUnit(PJ_CONTEXT* context, const PJ* horizontal, Crs& to) {
    ProjObject system{proj_crs_get_coordinate_system(context, horizontal)};
    double factor = 0;
    const char* name = nullptr;
    if (!system || !proj_cs_get_axis_info(context, system.get(), 0, nullptr, nullptr, nullptr, &factor, &name,
                                          nullptr, nullptr))
        return;
    to.unit = name ? name : "";
    if (proj_cs_get_type(context, system.get()) == PJ_CS_TYPE_CARTESIAN)
        to.unitMeters = factor;
}

void addAxes(PJ_CONTEXT* context, const PJ* crs, std::vector<CrsAxis>& to) {
    ProjObject system{proj_crs_get_coordinate_system(context, crs)};
    int count = system ? proj_cs_get_axis_count(context, system.get()) : 0;
    for (int i = 0; i < count; ++i) {
        const char *name = nullptr, *direction = nullptr, *unit = nullptr, *category = nullptr;
        double factor = 0;
        const char *authority = nullptr, *code = nullptr;
        if (!proj_cs_get_axis_info(context, system.get(), i, &name, nullptr, &direction, &factor, &unit,
                                   &authority, &code))
            continue;
        bool isLinear =
            !(authority && code) ||
            !proj_uom_get_info_from_database(context, authority, code, nullptr, nullptr, &category) ||
            std::string_view(category) == "linear";
        auto text = [](const char* from) { return std::string(from ? from : ""); };
        to.push_back({text(name), text(direction), text(unit), isLinear ? factor : 0});
    }
}

// As proj_normalize_for_visualization would have them.
void putEastFirst(std::vector<CrsAxis>& axes) {
    if (axes.size() < 2)
        return;
    bool northThenEast = axes[0].direction == "north" && axes[1].direction == "east";
    bool byName = axes[0].name.starts_with("Northing") && axes[1].name.starts_with("Easting");
    if (northThenEast || byName)
        std::swap(axes[0], axes[1]);
}

std::string wktOf(PJ_CONTEXT* context, const PJ* crs) {
    const char* singleLine[] = {"MULTILINE=NO", nullptr};
    for (PJ_WKT_TYPE type : {PJ_WKT1_GDAL, PJ_WKT2_2019})
        if (const char* wkt = proj_as_wkt(context, crs, type, singleLine))
            return wkt;
    return {};
}

} // namespace

Result<std::unique_ptr<ProjContext>> ProjContext::open() {
    // libgeotiff makes contexts of its own after PROJ's default one, which would print.
    static const PJ_LOG_LEVEL quiet = proj_log_level(nullptr, PJ_LOG_NONE);
    (void)quiet;
    std::unique_ptr<ProjContext> context(new ProjContext);
    if (!context->context_)
        return Error{ErrorCode::ioFailed, "PROJ could not be started", "", ""};
    proj_log_level(context->get(), PJ_LOG_ERROR);
    proj_log_func(context->get(), &context->messages_, keepMessage);
    proj_context_set_enable_network(context->get(), 0);
    if (!proj_context_get_database_path(context->get()))
        return Error{ErrorCode::ioFailed, "PROJ's database of coordinate systems, proj.db, was not found", "",
                     "install the package proj-data, or set PROJ_DATA (PROJ_LIB) to the folder that has it"};
    return context;
}

std::string ProjContext::takeMessages() {
    return std::exchange(messages_, {});
}

ProjObject ProjContext::fromEpsg(int code) {
    return ProjObject{proj_create_from_database(context_, "EPSG", std::to_string(code).c_str(),
                                                PJ_CATEGORY_CRS, 0, nullptr)};
}

ProjObject ProjContext::fromWkt(const std::string& wkt) {
    PROJ_STRING_LIST warnings = nullptr;
    PROJ_STRING_LIST errors = nullptr;
    ProjObject crs{proj_create_from_wkt(context_, wkt.c_str(), nullptr, &warnings, &errors)};
    for (PROJ_STRING_LIST error = errors; error && *error; ++error)
        keepMessage(&messages_, 0, *error);
    proj_string_list_destroy(warnings);
    proj_string_list_destroy(errors);
    return crs && proj_is_crs(crs.get()) ? std::move(crs) : nullptr;
}

ProjObject ProjContext::fromText(const std::string& text) {
    // "+proj=utm +zone=10" alone is a transformation.
    bool bareProj = text.find("+proj=") != std::string::npos && text.find("+type=crs") == std::string::npos;
    ProjObject crs{proj_create(context_, (bareProj ? text + " +type=crs" : text).c_str())};
    return crs && proj_is_crs(crs.get()) ? std::move(crs) : nullptr;
}

Crs ProjContext::describe(const ProjObject& given, const std::string& wkt) {
    Crs crs;
    // A CRS bound to WGS 84 by a transformation (TOWGS84) is described without it.
    ProjObject unbound;
    if (proj_get_type(given.get()) == PJ_TYPE_BOUND_CRS)
        unbound.reset(proj_get_source_crs(context_, given.get()));
    const PJ* whole = unbound ? unbound.get() : given.get();
    ProjObject horizontalPart;
    if (proj_get_type(whole) == PJ_TYPE_COMPOUND_CRS)
        horizontalPart.reset(proj_crs_get_sub_crs(context_, whole, 0));
    const PJ* horizontal = horizontalPart ? horizontalPart.get() : whole;

    const char* name = proj_get_name(given.get());
    crs.name = name ? name : "";
    crs.wkt = wkt.empty() ? wktOf(context_, given.get()) : wkt;
    crs.epsg = epsgCode(whole);
    if (!crs.epsg)
        crs.epsg = epsgCode(horizontal);
    if (!crs.epsg)
        crs.epsg = identifiedCode(context_, horizontal);
    if (const char* proj = proj_as_proj_string(context_, given.get(), PJ_PROJ_4, nullptr))
        crs.proj = proj;
    describeUnit(context_, horizontal, crs);
    addAxes(context_, horizontal, crs.axes);
    putEastFirst(crs.axes);
    if (horizontalPart)
        if (ProjObject vertical{proj_crs_get_sub_crs(context_, whole, 1)}) {
            crs.vertical = proj_get_name(vertical.get());
            addAxes(context_, vertical.get(), crs.axes);
        }
    takeMessages();
    return crs;
}

} // namespace stipple
