// What a style, and whoever counts what is in view, need of each cloud's nodes; and what is held of nodes
// that nothing needs any more.
#pragma once

#include "client/core/cloud_loader.hpp"
#include "client/core/node_cache.hpp"
#include "client/core/style.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace stipple {

// Sets CloudLoader::needs of each cloud, and anew what can be drawn of it where they changed. True: of one
// they did. `all`: every attribute is needed, whatever the style shows.
bool updateNeeds(CloudMap& clouds, NodeCache& cache, const Style& style, bool all);
// Sets CloudLoader::watched: attributes that are counted. Names that a cloud lacks are passed over.
void updateWatched(CloudMap& clouds, const std::vector<std::string>& names);

// Of a node of the cloud that is drawn in this style.
std::uint32_t bytesPerPoint(const CloudLoader& cloud, const Style& style);

// Lets go of attributes, and normals packed of them, that neither the style nor a watch needs. Answers of how
// many blocks.
std::uint64_t dropUnused(const CloudMap& clouds, NodeCache& cache, const Style& style);

} // namespace stipple
