// The list of clouds, page by page.
#pragma once

#include "server/api/endpoint.hpp"

namespace stipple::server {

// /clouds?limit=&after=: the clouds that the visitor may read, by id. A page whose clouds have all been open
// once is answered at once; another opens them one after the other, as a job. Clouds that can't be used now
// are left out: they say why when they are asked for.
Answer answerClouds(const ApiCall& call);

inline constexpr std::size_t usualCloudsInList = 100, mostCloudsInList = 1000;
inline constexpr Parameter cloudListParameters[] = {
    {.name = "limit",
     .description = "How many clouds at most.",
     .kind = ParameterKind::count,
     .least = 1,
     .most = mostCloudsInList,
     .example = "10",
     .usual = "100"},
    {.name = "after",
     .description = "Id behind which to go on; `next` of the answer has the address of what follows. From "
                    "the first if it is not given.",
     .example = "town"},
};

} // namespace stipple::server
