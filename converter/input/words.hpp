// The words of a header's line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stipple {

// What stands between blanks and tabs.
std::vector<std::string> wordsOf(std::string_view line);

} // namespace stipple
