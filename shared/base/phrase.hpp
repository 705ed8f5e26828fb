// A sentence, or a part of one, for a person, that remembers which of its parts are values. So programs that
// speak other languages than English can say it: what is between the values is its pattern, which a catalogue
// knows ("the header ends after {0} of {1} bytes"), and a value may be a phrase of its own.
#pragma once

#include "shared/base/text.hpp"

#include <string>
#include <string_view>
#include <utility>

namespace stipple {

class Phrase {
  public:
    // Around each value in marked(): the control characters STX and ETX.
    static constexpr char valueBegins = '\x02', valueEnds = '\x03';

    Phrase() = default;
    // One without values, or what marked() gave.
    Phrase(std::string marked) : marked_(std::move(marked)) {}
    Phrase(const char* text) : marked_(text) {}

    bool empty() const { return marked_.empty(); }
    std::string text() const; // in English
    operator std::string() const { return text(); }
    const std::string& marked() const { return marked_; }

    // In its English text.
    std::size_t find(std::string_view part) const { return text().find(part); }

    Phrase& operator+=(const Phrase& more) {
        marked_ += more.marked_;
        return *this;
    }
    friend bool operator==(const Phrase& phrase, std::string_view text) { return phrase.text() == text; }
    friend std::string operator+(std::string before, const Phrase& phrase) { return before + phrase.text(); }

    void addPattern(std::string_view part) { marked_ += part; }
    void addValue(std::string_view value);
    void addValue(const Phrase& value);

  private:
    std::string marked_;
};

namespace detail {
template <std::size_t N>
void addTo(Phrase& phrase, const char (&pattern)[N]) {
    phrase.addPattern(pattern);
}
inline void addTo(Phrase& phrase, const Phrase& value) {
    phrase.addValue(value);
}
template <class Value>
void addTo(Phrase& phrase, const Value& value) {
    phrase.addValue(std::string_view(cat(value)));
}
} // namespace detail

// say("the header ends after ", size, " of ", headerBytes, " bytes"): literals are the pattern, all else
// values. What the page shows of errors is said so: tests/e2e/phrases.test.mjs finds the patterns in the
// sources, and that every language has them.
template <class... Parts>
Phrase say(const Parts&... parts) {
    Phrase phrase;
    (detail::addTo(phrase, parts), ...);
    return phrase;
}

} // namespace stipple
