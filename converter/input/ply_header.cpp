#include "converter/input/ply_header.hpp"

#include "converter/input/words.hpp"
#include "shared/base/text.hpp"

#include <array>
#include <charconv>

namespace stipple {

namespace {
constexpr std::size_t longestLine = 4096, mostProperties = 1000;
constexpr std::uint64_t mostLines = 100'000;

struct TypeName {
    std::string_view name;
    AttributeType type;
};
constexpr std::array typeNames{
    TypeName{"char", AttributeType::i8},    TypeName{"int8", AttributeType::i8},
    TypeName{"uchar", AttributeType::u8},   TypeName{"uint8", AttributeType::u8},
    TypeName{"short", AttributeType::i16},  TypeName{"int16", AttributeType::i16},
    TypeName{"ushort", AttributeType::u16}, TypeName{"uint16", AttributeType::u16},
    TypeName{"int", AttributeType::i32},    TypeName{"int32", AttributeType::i32},
    TypeName{"uint", AttributeType::u32},   TypeName{"uint32", AttributeType::u32},
    TypeName{"int64", AttributeType::i64},  TypeName{"uint64", AttributeType::u64},
    TypeName{"float", AttributeType::f32},  TypeName{"float32", AttributeType::f32},
    TypeName{"double", AttributeType::f64}, TypeName{"float64", AttributeType::f64},
};

class HeaderReader {
  public:
    explicit HeaderReader(SharedSource& source) : source_(source), cursor_(source) {}

    Result<PlyHeader> read() {
        STIPPLE_TRY(first, nextWords());
        if (first != std::vector<std::string>{"ply"})
            return error("the first line is not \"ply\"");
        for (;;) {
            if (cursor_.atEnd())
                return Error{ErrorCode::truncated, "the header has no \"end_header\"", place(),
                             "was the file copied completely?"};
            STIPPLE_TRY(words, nextWords());
            if (words.empty() || words[0] == "comment" || words[0] == "obj_info")
                continue;
            if (words[0] == "end_header")
                break;
            if (words[0] == "format")
                STIPPLE_CHECK(readFormat(words));
            else if (words[0] == "element")
                STIPPLE_CHECK(readElement(words));
            else if (words[0] == "property")
                STIPPLE_CHECK(readProperty(words));
            else
                return error(cat("\"", words[0].substr(0, 40), "\" is no line of a header"));
        }
        if (!hasFormat_)
            return error("the header has no \"format\" line");
        STIPPLE_CHECK(checkVertices());
        header_.bodyOffset = cursor_.offset();
        header_.bodyLine = line_ + 1;
        return std::move(header_);
    }

  private:
    Result<std::vector<std::string>> nextWords() {
        auto line = cursor_.line(longestLine);
        if (!line)
            return line.error();
        if (++line_ > mostLines)
            return error("the header has too many lines");
        return wordsOf(*line);
    }

    Status readFormat(const std::vector<std::string>& words) {
        if (words.size() < 2 || hasFormat_)
            return error("the format line is not \"format NAME 1.0\"");
        hasFormat_ = true;
        if (words[1] == "ascii")
            header_.encoding = PlyEncoding::ascii;
        else if (words[1] == "binary_little_endian")
            header_.encoding = PlyEncoding::littleEndian;
        else if (words[1] == "binary_big_endian")
            header_.encoding = PlyEncoding::bigEndian;
        else
            return error(cat("there is no format \"", words[1].substr(0, 40), "\""));
        return {};
    }

    Status readElement(const std::vector<std::string>& words) {
        PlyElement element;
        if (words.size() != 3)
            return error("the element line is not \"element NAME COUNT\"");
        element.name = words[1];
        auto read = std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
        if (read.ec != std::errc{} || read.ptr != words[2].data() + words[2].size())
            return error(cat("\"", words[2].substr(0, 40), "\" is no number of elements"));
        header_.elements.push_back(std::move(element));
        return {};
    }

    Status readProperty(const std::vector<std::string>& words) {
        if (header_.elements.empty())
            return error("a property stands before the first element");
        PlyElement& element = header_.elements.back();
        const bool isList = words.size() > 1 && words[1] == "list";
        if (words.size() != (isList ? 5u : 3u))
            return error(
                "the property line is neither \"property TYPE NAME\" nor \"property list TYPE TYPE NAME\"");
        if (element.properties.size() == mostProperties)
            return error(cat("an element has more than ", mostProperties, " properties"));
        PlyProperty property;
        property.name = words.back();
        STIPPLE_TRY(type, typeOf(words[words.size() - 2]));
        property.type = type;
        if (isList) {
            STIPPLE_TRY(countType, typeOf(words[2]));
            if (countType == AttributeType::f32 || countType == AttributeType::f64)
                return error("the length of a list is no integer");
            property.listCountType = countType;
        }
        element.properties.push_back(std::move(property));
        return {};
    }

    Result<AttributeType> typeOf(const std::string& name) const {
        for (const TypeName& known : typeNames)
            if (known.name == name)
                return known.type;
        return error(cat("there is no type \"", name.substr(0, 40), "\""));
    }

    Status checkVertices() const {
        int found = 0;
        for (const PlyElement& element : header_.elements)
            found += element.name == "vertex" ? 1 : 0;
        if (found != 1)
            return error(found == 0 ? "the file has no element \"vertex\""
                                    : "the file has several elements \"vertex\"");
        return {};
    }

    std::string place() const { return cat(source_.name(), ", line ", line_); }
    Error error(const std::string& what) const {
        return {ErrorCode::corrupt, what, place(), "the header is damaged, or of no PLY file"};
    }

    SharedSource& source_;
    FileCursor cursor_;
    PlyHeader header_;
    std::uint64_t line_ = 0;
    bool hasFormat_ = false;
};
} // namespace

Result<PlyHeader> readPlyHeader(SharedSource& source) {
    return HeaderReader(source).read();
}

} // namespace stipple
