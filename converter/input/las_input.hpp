// LAS and LAZ files as inputs.
#pragma once

#include "converter/input/point_input.hpp"
#include "shared/io/byte_source.hpp"
#include "shared/las/las_reader.hpp"

namespace stipple {

// "LAS 1.2, point format 2", or "LAZ …".
std::string lasFormatText(const las::Header& header);

// A LAS or LAZ file and the bytes behind it. Errors name the file.
struct OpenLas {
    std::unique_ptr<ByteSource> source;
    std::unique_ptr<las::Reader> reader;
};
Result<OpenLas> openLas(const std::string& path);

// Parts begin where LAZ chunks do; threads read with readers of their own. Answers `changed` where the file
// is another one than when it was opened.
Result<std::unique_ptr<PointInput>> openLasInput(const std::string& path);

} // namespace stipple
