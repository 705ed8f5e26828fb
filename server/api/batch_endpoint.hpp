// /clouds/{id}/nodes?keys=…: several nodes as stored in one answer, for clients that are far away: one round
// trip in place of one for each node. The body is a row of frames, in the order of the keys:
//
//   u32  status: 200, or 404 (the cloud has no such node; no bytes follow)
//   u32  level, u32 x, u32 y, u32 z of the node's key
//   u32  strata that the bytes hold
//   u64  number of bytes that follow
//   …    the bytes, as /clouds/{id}/nodes/{key}?format=stored has them
//
// Numbers are little-endian. (Ranges of the file that are no nodes: a request for /clouds/ID.stipple with
// several ranges.)
#pragma once

#include "server/api/endpoint.hpp"
#include "server/api/node_request.hpp"
#include "server/api/validity.hpp"
#include "server/http/negotiation.hpp"

#include <array>

namespace stipple::server {

inline constexpr std::size_t maxBatchKeys = 256;
inline constexpr std::uint64_t maxBatchBytes = 64ull << 20;
inline constexpr std::size_t batchFrameBytes = 32; // before a node's bytes

inline constexpr Format batchFormat{"frames", "application/vnd.stipple.nodes", "bin"};
inline constexpr Parameter keysParameter{
    .name = "keys",
    .description = "Keys of nodes, joined by commas, at most 256. \"1-0-1-0:2\" asks for two strata of that "
                   "node, whatever the parameter strata says.",
    .example = "0-0-0-0",
    .isRequired = true,
    .pattern = "^\\d+-\\d+-\\d+-\\d+(:[1-4])?(,\\d+-\\d+-\\d+-\\d+(:[1-4])?)*$",
};
inline constexpr std::array batchParameters{keysParameter, strataParameter, attributesParameter,
                                            versionParameter};

Answer answerBatch(const ApiCall& call);

} // namespace stipple::server
