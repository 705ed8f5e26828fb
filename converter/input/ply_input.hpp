// PLY files as inputs: the element "vertex", ASCII or binary. Every scalar property is an attribute; lists,
// and other elements such as faces, are left out, which a warning says.
#pragma once

#include "converter/input/shared_source.hpp"
#include "converter/input/table.hpp"

namespace stipple {

// Files whose vertices are records of one size are read in parts. `source` is of the file at `path`.
Result<std::unique_ptr<PointInput>>
openPlyInput(const std::string& path, std::unique_ptr<SharedSource> source, const InputOptions& options);

} // namespace stipple
