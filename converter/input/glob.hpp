// Patterns of file names, matched on UTF-8.
#pragma once

#include <string_view>

namespace stipple {

// Does the text have a character that patterns give a meaning to: * ? [
bool isPattern(std::string_view text);

// Whether one part of a path (between slashes) fits one part of a pattern: `*` any characters, `?` one,
// `[abc]` `[a-z]` one of these, `[!…]` `[^…]` one of the others; a `[` that is never closed is itself. A name
// that begins with a dot fits only a pattern that does. Cost: at most the product of the lengths.
bool matchesPattern(std::string_view name, std::string_view pattern);

} // namespace stipple
