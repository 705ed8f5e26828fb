// Entity tags (RFC 9110 §8.8.3). A tag is kept as it stands in the field: "abc" or W/"abc", quotes included.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stipple::server {

// The value of If-Match or If-None-Match: "*" or a list of tags. Nothing if it is malformed.
struct EntityTagList {
    bool any = false; // "*"
    std::vector<std::string_view> tags;
};
std::optional<EntityTagList> parseEntityTagList(std::string_view text);

bool isStrongTag(std::string_view tag);
bool strongMatch(std::string_view a, std::string_view b); // both strong and equal
bool weakMatch(std::string_view a, std::string_view b);   // equal but for W/

// A strong tag for bytes held in memory: their 64-bit FNV-1a hash and their size.
std::string tagOfText(std::string_view text);

} // namespace stipple::server
