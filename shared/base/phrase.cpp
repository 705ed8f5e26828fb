#include "shared/base/phrase.hpp"

namespace stipple {

namespace {
bool isMark(char c) {
    return c == Phrase::valueBegins || c == Phrase::valueEnds;
}
} // namespace

std::string Phrase::text() const {
    std::string plain = marked_;
    std::erase_if(plain, isMark);
    return plain;
}

void Phrase::addValue(std::string_view value) {
    marked_ += valueBegins;
    for (char c : value)
        if (!isMark(c))
            marked_ += c;
    marked_ += valueEnds;
}

void Phrase::addValue(const Phrase& value) {
    marked_ += valueBegins;
    marked_ += value.marked_;
    marked_ += valueEnds;
}

} // namespace stipple
