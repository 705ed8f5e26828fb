// What a decoding worker has to know of a cloud, in a message from the page: the shape of its cube, of its
// attributes and of its picture. The rest of the metadata stays behind, and with it the reading of JSON,
// which the worker's program is smaller without.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"

namespace stipple::web {

Bytes encodeCloud(const CloudMetadata& metadata);
// Metadata with those fields alone. Errors: corrupt, for what encodeCloud() does not write.
Result<CloudMetadata> decodeCloud(ByteSpan message);

} // namespace stipple::web
