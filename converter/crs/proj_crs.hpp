// A thin layer over PROJ: objects that free themselves, messages that are kept instead of printed, and
// the description of a CRS as a Crs.
#pragma once

#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"

#include <proj.h>

#include <memory>
#include <string>

namespace stipple {

struct ProjDeleter {
    void operator()(PJ* object) const { proj_destroy(object); }
};
using ProjObject = std::unique_ptr<PJ, ProjDeleter>;

class ProjContext {
  public:
    // ioFailed if PROJ's database is missing.
    static Result<std::unique_ptr<ProjContext>> open();
    ~ProjContext() { proj_context_destroy(context_); }
    ProjContext(const ProjContext&) = delete;
    ProjContext& operator=(const ProjContext&) = delete;

    PJ_CONTEXT* get() const { return context_; }
    // What PROJ complained of since the last call, in one line; empty if nothing.
    std::string takeMessages();

    // Null where there is no such CRS.
    ProjObject fromEpsg(int code);
    ProjObject fromWkt(const std::string& wkt);
    ProjObject fromText(const std::string& text); // anything PROJ understands that is a CRS

    // Name, EPSG code, PROJ string, units, axes; and WKT 1 (GDAL's dialect, as LAS wants it; WKT 2 where WKT
    // 1 has no words for it) unless `wkt` is given.
    Crs describe(const ProjObject& crs, const std::string& wkt = {});

  private:
    ProjContext() : context_(proj_context_create()) {}
    PJ_CONTEXT* context_;
    std::string messages_;
};

} // namespace stipple
