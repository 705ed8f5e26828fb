#include "converter/crs/crs.hpp"

#include "converter/crs/geotiff_keys.hpp"
#include "converter/crs/proj_crs.hpp"
#include "shared/base/text.hpp"
#include "shared/las/header_block.hpp"

#include <geo_normalize.h>
#include <geo_simpletags.h>
#include <geo_tiffp.h>
#include <geotiff.h>
#include <proj_experimental.h>

#include <cmath>
#include <map>
#include <mutex>

namespace stipple {

namespace {

// GeoTIFF key ids and the value that means "defined by the other keys" (OGC GeoTIFF 1.1, annex).
constexpr std::uint16_t modelType = 1024, citation = 1026, geodeticCrs = 2048, projectedCrs = 3072,
                        linearUnit = 3076, linearUnitSize = 3077, verticalCrs = 4096;
constexpr int userDefined = 32767, geocentricModel = 3;

constexpr std::size_t maxWktBytes = 1 << 20;

// libgeotiff has nothing to say that the result does not show; it would print otherwise.
void ignoreGeotiffMessage(GTIF*, int, const char*, ...) {}

// The keys in libgeotiff's hands.
class GeotiffReader {
  public:
    GeotiffReader(const GeoKeys& keys, ProjContext& proj) : tags_(ST_Create()) {
        std::vector<std::uint16_t> directory = keys.directory();
        ST_SetKey(tags_, las::records::geoKeyDirectory, static_cast<int>(directory.size()), STT_SHORT,
                  directory.data());
        std::vector<double> doubles = keys.doubles;
        if (!doubles.empty())
            ST_SetKey(tags_, las::records::geoDoubleParams, static_cast<int>(doubles.size()), STT_DOUBLE,
                      doubles.data());
        std::string characters = keys.characters;
        if (!characters.empty())
            ST_SetKey(tags_, las::records::geoAsciiParams, static_cast<int>(characters.size()), STT_ASCII,
                      characters.data());
        TIFFMethod methods;
        GTIFSetSimpleTagsMethods(&methods);
        gtif_ = GTIFNewWithMethodsEx(tags_, &methods, ignoreGeotiffMessage, nullptr);
        if (gtif_)
            GTIFAttachPROJContext(gtif_, proj.get());
    }
    ~GeotiffReader() {
        if (gtif_)
            GTIFFree(gtif_);
        ST_Destroy(tags_);
    }
    GeotiffReader(const GeotiffReader&) = delete;
    GeotiffReader& operator=(const GeotiffReader&) = delete;

    // The PROJ string of a CRS whose parameters the keys spell out; empty if they do not.
    std::string projString() const {
        GTIFDefn definition;
        if (!gtif_ || !GTIFGetDefn(gtif_, &definition))
            return {};
        char* text = GTIFGetProj4Defn(&definition);
        std::string proj = text ? text : "";
        GTIFFreeMemory(text);
        return proj == "unknown" ? "" : proj;
    }

    std::string text(std::uint16_t key) const {
        char buffer[256] = {};
        if (!gtif_ || GTIFKeyGetASCII(gtif_, static_cast<geokey_t>(key), buffer, sizeof buffer) <= 0)
            return {};
        std::string value = buffer;
        return value.substr(0, value.find('|'));
    }

  private:
    ST_TIFF* tags_;
    GTIF* gtif_ = nullptr;
};

// Metres of the keys' linear unit; 0 if they name none.
double linearUnitMeters(const GeoKeys& keys, ProjContext& proj) {
    int code = keys.number(linearUnit);
    if (code <= 0)
        return 0;
    if (code == userDefined) {
        for (const GeoKey& key : keys.keys)
            if (key.id == linearUnitSize && key.tag == las::records::geoDoubleParams)
                return keys.doubles[key.value];
        return 0;
    }
    double factor = 0;
    const char* category = nullptr;
    if (!proj_uom_get_info_from_database(proj.get(), "EPSG", std::to_string(code).c_str(), nullptr, &factor,
                                         &category) ||
        std::string(category) != "linear")
        return 0;
    return factor;
}

// A projected CRS by its code, in the unit the keys name where that is another.
ProjObject inLinearUnit(ProjObject crs, const GeoKeys& keys, ProjContext& proj) {
    double meters = linearUnitMeters(keys, proj);
    Crs described = proj.describe(crs);
    if (!(meters > 0) || !std::isfinite(meters) || described.unitMeters == 0 ||
        std::abs(meters - described.unitMeters) <= 1e-12 * meters)
        return crs;
    std::string code = std::to_string(keys.number(linearUnit));
    const char* name = nullptr;
    proj_uom_get_info_from_database(proj.get(), "EPSG", code.c_str(), &name, nullptr, nullptr);
    ProjObject altered{proj_crs_alter_cs_linear_unit(proj.get(), crs.get(), name ? name : "unknown", meters,
                                                     name ? "EPSG" : nullptr, name ? code.c_str() : nullptr)};
    if (!altered)
        return crs;
    // It is no longer the system of that code; the name says what was changed.
    std::string title = cat(described.name, " (", name ? name : "other unit", ")");
    ProjObject named{proj_alter_name(proj.get(), altered.get(), title.c_str())};
    return named ? std::move(named) : std::move(altered);
}

// GeoTIFF 1.0 names the geographic system even where the coordinates are geocentric.
ProjObject geocentricOf(ProjObject crs, ProjContext& proj) {
    if (!crs || proj_get_type(crs.get()) == PJ_TYPE_GEOCENTRIC_CRS)
        return crs;
    ProjObject datum{proj_crs_get_datum_forced(proj.get(), crs.get())};
    std::string name = cat(proj_get_name(crs.get()), " (geocentric)");
    return ProjObject{
        datum ? proj_create_geocentric_crs_from_datum(proj.get(), name.c_str(), datum.get(), "metre", 1)
              : nullptr};
}

// A CRS whose parameters the keys spell out, or null.
ProjObject spelledOut(const GeoKeys& keys, ProjContext& proj) {
    GeotiffReader reader(keys, proj);
    std::string definition = reader.projString();
    if (definition.empty())
        return nullptr;
    ProjObject crs = proj.fromText(definition);
    // The PROJ string knows the ellipsoid only; the code of the geodetic system has the datum too.
    int geodetic = keys.number(geodeticCrs);
    if (crs && geodetic > 0 && geodetic != userDefined && keys.number(projectedCrs) > 0)
        if (ProjObject base = proj.fromEpsg(geodetic))
            if (ProjObject based{proj_crs_alter_geodetic_crs(proj.get(), crs.get(), base.get())})
                crs = std::move(based);
    std::string name = las::readableText(reader.text(citation));
    if (!crs || name.empty())
        return crs;
    ProjObject named{proj_alter_name(proj.get(), crs.get(), name.c_str())};
    return named ? std::move(named) : std::move(crs);
}

// The horizontal CRS of the keys, or null with a warning.
ProjObject horizontalOf(const GeoKeys& keys, ProjContext& proj, std::vector<std::string>& warnings) {
    int projected = keys.number(projectedCrs), geodetic = keys.number(geodeticCrs);
    if (projected > 0 && projected != userDefined) {
        if (ProjObject crs = proj.fromEpsg(projected))
            return inLinearUnit(std::move(crs), keys, proj);
        warnings.push_back(
            cat("the GeoTIFF keys name the projected system EPSG:", projected, ", which PROJ does not know"));
    }
    if (projected <= 0 && geodetic > 0 && geodetic != userDefined) {
        ProjObject crs = proj.fromEpsg(geodetic);
        if (!crs)
            warnings.push_back(cat("the GeoTIFF keys name the geodetic system EPSG:", geodetic,
                                   ", which PROJ does not know"));
        return keys.number(modelType) == geocentricModel ? geocentricOf(std::move(crs), proj)
                                                         : std::move(crs);
    }
    return spelledOut(keys, proj);
}

// With the vertical system of the keys, where they name one.
ProjObject withVertical(ProjObject horizontal, const GeoKeys& keys, ProjContext& proj,
                        std::vector<std::string>& warnings) {
    int code = keys.number(verticalCrs);
    // 5001-5033 are GeoTIFF 1.0's heights above an ellipsoid: no system of their own.
    bool ellipsoidal = code >= 5001 && code <= 5033;
    if (code <= 0 || code == userDefined || ellipsoidal)
        return horizontal;
    ProjObject vertical = proj.fromEpsg(code);
    if (!vertical || proj_get_type(vertical.get()) != PJ_TYPE_VERTICAL_CRS) {
        warnings.push_back(cat("the GeoTIFF keys name the vertical system EPSG:", code,
                               ", which PROJ does not know as one; heights are taken without"));
        return horizontal;
    }
    std::string name = cat(proj_get_name(horizontal.get()), " + ", proj_get_name(vertical.get()));
    ProjObject compound{proj_create_compound_crs(proj.get(), name.c_str(), horizontal.get(), vertical.get())};
    return compound ? std::move(compound) : std::move(horizontal);
}

Crs crsOfKeys(const las::Header& header, ProjContext& proj, std::vector<std::string>& warnings) {
    GeoKeys keys = geoKeysOf(header, warnings);
    if (keys.empty())
        return {};
    ProjObject crs = horizontalOf(keys, proj, warnings);
    std::string messages = proj.takeMessages();
    if (!crs) {
        warnings.push_back(cat("the GeoTIFF keys give no coordinate system that PROJ understands",
                               messages.empty() ? "" : ": ", messages));
        return {};
    }
    return proj.describe(withVertical(std::move(crs), keys, proj, warnings));
}

Crs crsOfWkt(const std::string& wkt, ProjContext& proj, std::vector<std::string>& warnings) {
    if (wkt.empty())
        return {};
    if (wkt.size() > maxWktBytes) {
        warnings.push_back(cat("the WKT record of ", wkt.size(), " bytes is too long for a definition"));
        return {};
    }
    ProjObject crs = proj.fromWkt(wkt);
    std::string messages = proj.takeMessages();
    if (crs)
        return proj.describe(crs, wkt);
    warnings.push_back(
        cat("PROJ does not understand the WKT record", messages.empty() ? "" : ": ", messages));
    return {};
}

// Some software marks local or projected coordinates as geocentric. On the Earth, those lie about 6,371 km
// from its centre.
void dropImpossible(CrsReading& reading, const BoxD& bounds) {
    constexpr double leastRadius = 6.3e6, greatestRadius = 6.5e6;
    if (reading.crs.proj.find("+proj=geocent") == std::string::npos || reading.crs.unitMeters == 0)
        return;
    double radius = length((bounds.min + bounds.max) * (reading.crs.unitMeters / 2));
    if (radius >= leastRadius && radius <= greatestRadius)
        return;
    reading.warnings.push_back(cat("the file says its coordinates are geocentric (", reading.crs.name,
                                   "), but they lie ", std::round(radius / 1000),
                                   " km from the Earth's centre; its system is taken as unknown"));
    reading.crs = {};
}

bool wktMustHold(const las::Header& header) {
    constexpr std::uint16_t wktBit = 1u << 4; // LAS 1.4 R15 table 4
    return header.versionMinor >= 4 && (header.globalEncoding & wktBit) != 0;
}

CrsReading readRecords(const las::Header& header, ProjContext& proj) {
    CrsReading reading;
    bool wktHolds = wktMustHold(header);
    std::string wkt = las::wktRecord(header);
    Crs byWkt, byKeys;
    if (wktHolds)
        byWkt = crsOfWkt(wkt, proj, reading.warnings);
    if (!byWkt.known())
        byKeys = crsOfKeys(header, proj, reading.warnings);
    // Keys that name no system by its code spell out an ellipsoid and a projection, but lose the datum.
    if (!wktHolds && !byKeys.epsg)
        byWkt = crsOfWkt(wkt, proj, reading.warnings);
    reading.crs = byWkt.known() ? std::move(byWkt) : std::move(byKeys);
    return reading;
}

// What PROJ made of texts and records seen before: the hundreds of tiles of a survey bear the same ones, and
// each reading costs it a tenth of a second and more.
template <class T>
class Known {
  public:
    std::optional<T> find(const std::string& key) {
        std::lock_guard lock(mutex_);
        auto found = kept_.find(key);
        return found == kept_.end() ? std::nullopt : std::optional(found->second);
    }
    void keep(const std::string& key, const T& value) {
        constexpr std::size_t maxKept = 64, maxKeyBytes = 1 << 16;
        std::lock_guard lock(mutex_);
        if (key.size() <= maxKeyBytes && kept_.size() < maxKept)
            kept_.emplace(key, value);
    }

  private:
    std::mutex mutex_;
    std::map<std::string, T> kept_;
};

// All that readRecords looks at.
std::string recordsKey(const las::Header& header) {
    std::string key = wktMustHold(header) ? "w" : "k";
    for (const las::Vlr& vlr : header.vlrs)
        if (vlr.userId == las::records::projection)
            key += cat(vlr.recordId, " ", vlr.omitted ? 1 : 0, " ", vlr.data.size(), ":",
                       std::string_view(reinterpret_cast<const char*>(vlr.data.data()), vlr.data.size()));
    return key;
}

} // namespace

Result<CrsReading> crsOfLas(const las::Header& header) {
    static Known<CrsReading> known;
    STIPPLE_TRY(proj, ProjContext::open());
    std::string key = recordsKey(header);
    std::optional<CrsReading> reading = known.find(key);
    if (!reading) {
        reading = readRecords(header, *proj);
        known.keep(key, *reading);
    }
    dropImpossible(*reading, header.bounds);
    return std::move(*reading);
}

Result<Crs> crsFromUser(const std::string& text) {
    static Known<Crs> known;
    STIPPLE_TRY(proj, ProjContext::open());
    if (std::optional<Crs> crs = known.find(text))
        return std::move(*crs);
    ProjObject object = proj->fromText(text);
    std::string messages = proj->takeMessages();
    if (!object)
        return Error{
            ErrorCode::invalidArgument,
            cat("is no coordinate system that PROJ understands", messages.empty() ? "" : ": ", messages),
            cat("\"", text, "\""), "give EPSG:n, WKT, or a PROJ string"};
    Crs crs = proj->describe(object);
    known.keep(text, crs);
    return crs;
}

Result<std::string> wktOfEpsg(int code) {
    STIPPLE_TRY(crs, crsFromUser("EPSG:" + std::to_string(code)));
    return crs.wkt;
}

} // namespace stipple
