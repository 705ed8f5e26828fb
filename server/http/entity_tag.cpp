#include "server/http/entity_tag.hpp"

#include "server/http/message.hpp"

#include <cstdio>

namespace stipple::server {

namespace {

// etagc: any visible byte but the quote; bytes from 0x80 on are allowed (obs-text).
bool isTagByte(char c) {
    auto byte = static_cast<unsigned char>(c);
    return byte == 0x21 || (byte >= 0x23 && byte != 0x7F);
}

// Takes a tag off the front of `text`; empty if none is there.
std::string_view takeTag(std::string_view& text) {
    std::size_t at = text.starts_with("W/") ? 2 : 0;
    if (at >= text.size() || text[at] != '"')
        return {};
    std::size_t end = at + 1;
    while (end < text.size() && isTagByte(text[end]))
        ++end;
    if (end >= text.size() || text[end] != '"')
        return {};
    std::string_view tag = text.substr(0, end + 1);
    text.remove_prefix(end + 1);
    return tag;
}

std::string_view opaque(std::string_view tag) {
    return tag.starts_with("W/") ? tag.substr(2) : tag;
}

} // namespace

std::optional<EntityTagList> parseEntityTagList(std::string_view text) {
    EntityTagList list;
    text = trimmed(text);
    if (text == "*") {
        list.any = true;
        return list;
    }
    while (!text.empty()) {
        if (text.front() == ',') { // empty list elements are ignored (RFC 9110 §5.6.1.2)
            text = trimmed(text.substr(1));
            continue;
        }
        std::string_view tag = takeTag(text);
        text = trimmed(text);
        if (tag.empty() || (!text.empty() && text.front() != ','))
            return std::nullopt;
        list.tags.push_back(tag);
    }
    if (list.tags.empty())
        return std::nullopt;
    return list;
}

bool isStrongTag(std::string_view tag) {
    return takeTag(tag).starts_with('"') && tag.empty();
}

bool strongMatch(std::string_view a, std::string_view b) {
    return a == b && isStrongTag(a);
}

bool weakMatch(std::string_view a, std::string_view b) {
    return opaque(a) == opaque(b);
}

std::string tagOfText(std::string_view text) {
    std::uint64_t hash = 0xCBF29CE484222325ull;
    for (char c : text)
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ull;
    char tag[48];
    std::snprintf(tag, sizeof tag, "\"%016llx-%zx\"", static_cast<unsigned long long>(hash), text.size());
    return tag;
}

} // namespace stipple::server
