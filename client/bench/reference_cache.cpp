#include "client/bench/reference_cache.hpp"

#include "client/core/json.hpp"
#include "shared/base/text.hpp"
#include "shared/codec/checksum.hpp"
#include "shared/codec/section.hpp"
#include "shared/io/output_file.hpp"

#include <nlohmann/json.hpp>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace stipple::bench {
namespace {

// A file: three sections (shared/codec/section.hpp) behind the sizes of the first: the key, R, G, B of all
// pixels, the distances as float32.
//   u32 bytes of the key | section key | section colours | section distances
ByteSpan bytesOf(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

nlohmann::json vector(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

} // namespace

ReferenceCache::ReferenceCache(std::string folder, const CloudMetadata& metadata)
    : folder_(std::move(folder)) {
    BoxD bounds = metadata.worldBounds();
    nlohmann::json cloud{{"pointHash", metadata.pointHash},
                         {"points", metadata.pointCount},
                         {"scale", vector(metadata.grid.scale)},
                         {"offset", vector(metadata.grid.offset)},
                         {"min", vector(bounds.min)},
                         {"max", vector(bounds.max)}};
    cloud_ = jsonText(cloud);
}

std::string ReferenceCache::keyOf(const ReferenceRequest& request) const {
    nlohmann::json key{{"referenceVersion", reference::referenceVersion},
                       {"camera", toJson(request.camera)},
                       {"style", toJson(request.style)},
                       {"size", {request.width, request.height}},
                       {"samples", request.samples}};
    return cat(cloud_, "\n", jsonText(key));
}

std::string ReferenceCache::pathOf(const std::string& key) const {
    char name[48];
    std::snprintf(name, sizeof name, "%016llx%016llx.reference",
                  static_cast<unsigned long long>(xxh64(bytesOf(key))),
                  static_cast<unsigned long long>(xxh64(bytesOf(key), 1)));
    return cat(folder_, "/", name);
}

bool ReferenceCache::has(const ReferenceRequest& request) const {
    return !folder_.empty() && std::filesystem::exists(pathOf(keyOf(request)));
}

std::optional<DepthImage> ReferenceCache::find(const ReferenceRequest& request) const {
    if (folder_.empty())
        return std::nullopt;
    std::string key = keyOf(request);
    std::ifstream file(pathOf(key), std::ios::binary);
    Bytes bytes((std::istreambuf_iterator<char>(file)), {});
    ByteReader reader(bytes);
    std::size_t pixels = static_cast<std::size_t>(request.width) * static_cast<std::size_t>(request.height);
    if (reader.read<std::uint32_t>() != key.size() || !reader.ok())
        return std::nullopt;
    Bytes held(key.size()), rgb(3 * pixels), distances(4 * pixels);
    bool read = readFullSection(reader, held).ok() && readFullSection(reader, rgb).ok() &&
                readFullSection(reader, distances).ok();
    if (!read || std::memcmp(held.data(), key.data(), key.size()) != 0)
        return std::nullopt;
    DepthImage picture{{request.width, request.height, Bytes(4 * pixels, 255)}, std::vector<float>(pixels)};
    for (std::size_t i = 0; i < pixels; ++i) {
        std::memcpy(&picture.image.rgba[4 * i], &rgb[3 * i], 3);
        picture.distances[i] = loadLe<float>(&distances[4 * i]);
    }
    return picture;
}

Status ReferenceCache::put(const ReferenceRequest& request, const DepthImage& picture) const {
    if (folder_.empty())
        return {};
    std::error_code failed;
    std::filesystem::create_directories(folder_, failed);
    if (failed)
        return Error{ErrorCode::writeFailed, cat("the folder can't be made: ", failed.message()), folder_,
                     ""};
    std::string key = keyOf(request);
    std::size_t pixels = picture.distances.size();
    Bytes rgb(3 * pixels), distances(4 * pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        std::memcpy(&rgb[3 * i], &picture.image.rgba[4 * i], 3);
        storeLe(&distances[4 * i], picture.distances[i]);
    }
    ByteWriter writer;
    writer.write(static_cast<std::uint32_t>(key.size()));
    for (ByteSpan part : {bytesOf(key), ByteSpan(rgb), ByteSpan(distances)})
        writeSection(writer, part, Effort::fast);
    STIPPLE_TRY(file, OutputFile::create(pathOf(key)));
    STIPPLE_CHECK(file->append(writer.bytes()));
    return file->commit();
}

} // namespace stipple::bench
