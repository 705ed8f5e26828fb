// Elements of an E57 file's XML section, and the values they hold (ASTM E2807-11 §8.3): numbers as text,
// an empty element being 0, a missing attribute its default.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace stipple::e57 {

class XmlText;

// An element, or none: a child that is not there has no children, no text and no numbers. Lives as long as
// its XmlText.
class XmlElement {
  public:
    XmlElement(pugi::xml_node node, std::uint64_t xmlOffset) : node_(node), xmlOffset_(xmlOffset) {}

    explicit operator bool() const { return !node_.empty(); }
    std::string_view name() const { return node_.name(); }
    std::string_view type() const { return attribute("type"); }
    std::string_view attribute(const char* name) const { return node_.attribute(name).value(); }
    XmlElement child(const char* name) const { return {node_.child(name), xmlOffset_}; }
    std::vector<XmlElement> children() const; // elements only
    std::string text() const;                 // without spaces at its ends

    Result<std::int64_t> integerAttribute(const char* name, std::int64_t absent) const;
    Result<double> numberAttribute(const char* name, double absent) const; // finite
    Result<std::uint64_t> unsignedAttribute(const char* name) const;       // must be there
    // The value of an Integer, ScaledInteger or Float; nothing where there is no such child.
    Result<std::optional<double>> childNumber(const char* name) const;

    // The error, with the element's name and its place in the file.
    Error error(ErrorCode code, const std::string& what) const;

  private:
    pugi::xml_node node_;
    std::uint64_t xmlOffset_; // of the text in the file, logical
};

class XmlText {
  public:
    Status parse(ByteSpan xml, std::uint64_t xmlOffset);
    XmlElement root() const { return {document_.document_element(), xmlOffset_}; }

  private:
    pugi::xml_document document_;
    std::uint64_t xmlOffset_ = 0;
};

} // namespace stipple::e57
