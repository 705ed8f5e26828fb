#include "converter/input/pcd_header.hpp"

#include "converter/input/words.hpp"
#include "shared/base/text.hpp"

#include <array>
#include <charconv>
#include <map>

namespace stipple {

namespace {
constexpr std::size_t longestLine = std::size_t{1} << 16;
constexpr std::size_t mostFields = 1000;
constexpr std::uint64_t mostLines = 1000;
constexpr std::array<std::string_view, 10> keywords{"VERSION", "FIELDS", "SIZE",      "TYPE",   "COUNT",
                                                    "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};

using Words = std::vector<std::string>;

bool readInteger(const std::string& word, std::uint64_t& value) {
    auto read = std::from_chars(word.data(), word.data() + word.size(), value);
    return read.ec == std::errc{} && read.ptr == word.data() + word.size();
}

std::optional<AttributeType> typeOf(const std::string& type, std::uint64_t size) {
    struct Row {
        char letter;
        std::uint64_t size;
        AttributeType type;
    };
    constexpr std::array rows{Row{'U', 1, AttributeType::u8},  Row{'I', 1, AttributeType::i8},
                              Row{'U', 2, AttributeType::u16}, Row{'I', 2, AttributeType::i16},
                              Row{'U', 4, AttributeType::u32}, Row{'I', 4, AttributeType::i32},
                              Row{'U', 8, AttributeType::u64}, Row{'I', 8, AttributeType::i64},
                              Row{'F', 4, AttributeType::f32}, Row{'F', 8, AttributeType::f64}};
    for (const Row& row : rows)
        if (type.size() == 1 && type[0] == row.letter && size == row.size)
            return row.type;
    return {};
}

class HeaderReader {
  public:
    explicit HeaderReader(SharedSource& source) : source_(source), cursor_(source) {}

    Result<PcdHeader> read() {
        while (lines_.count("DATA") == 0)
            STIPPLE_CHECK(readLine());
        header_.bodyOffset = cursor_.offset();
        header_.bodyLine = line_ + 1;
        STIPPLE_CHECK(readFields());
        STIPPLE_CHECK(readPoints());
        STIPPLE_CHECK(readEncoding());
        readViewpoint();
        return std::move(header_);
    }

  private:
    Status readLine() {
        if (cursor_.atEnd())
            return Error{ErrorCode::truncated, "the header has no DATA line", place(),
                         "was the file copied completely?"};
        auto line = cursor_.line(longestLine);
        if (!line)
            return line.error();
        if (++line_ > mostLines)
            return error("the header has too many lines");
        Words words = wordsOf(*line);
        if (words.empty() || words[0][0] == '#')
            return {};
        std::string keyword = words[0] == "COLUMNS" ? "FIELDS" : words[0]; // an older name
        for (std::string_view known : keywords)
            if (known == keyword) {
                words.erase(words.begin());
                if (!lines_.emplace(keyword, std::move(words)).second)
                    return error(cat("there are two lines ", keyword));
                return {};
            }
        return error(cat("\"", words[0].substr(0, 40), "\" is no line of a header"));
    }

    Result<Words> need(const std::string& keyword) const {
        auto found = lines_.find(keyword);
        if (found == lines_.end() || found->second.empty())
            return error(cat("the header has no ", keyword));
        return found->second;
    }

    Status readFields() {
        STIPPLE_TRY(names, need("FIELDS"));
        STIPPLE_TRY(sizes, need("SIZE"));
        STIPPLE_TRY(types, need("TYPE"));
        Words counts(names.size(), "1"); // as in version 0.5, which has no COUNT
        if (lines_.count("COUNT") > 0)
            counts = lines_["COUNT"];
        if (names.size() > mostFields)
            return error(cat("there are more than ", mostFields, " fields"));
        if (sizes.size() != names.size() || types.size() != names.size() || counts.size() != names.size())
            return error(cat("FIELDS names ", names.size(), " fields, but SIZE, TYPE and COUNT have ",
                             sizes.size(), ", ", types.size(), " and ", counts.size()));
        for (std::size_t i = 0; i < names.size(); ++i)
            STIPPLE_CHECK(addField(names[i], sizes[i], types[i], counts[i]));
        return {};
    }

    Status addField(const std::string& name, const std::string& sizeWord, const std::string& typeWord,
                    const std::string& countWord) {
        constexpr std::uint64_t mostValues = 255, mostPadding = 65536;
        std::uint64_t size = 0, count = 0;
        if (!readInteger(sizeWord, size) || !typeOf(typeWord, size))
            return error(cat("the field ", name, " has TYPE ", typeWord, " and SIZE ", sizeWord,
                             ", which is no type"));
        if (!readInteger(countWord, count) || count == 0 || count > (name == "_" ? mostPadding : mostValues))
            return error(cat("the field ", name, " has COUNT ", countWord, "; 1 to 255 are read"));
        header_.fields.push_back({name, *typeOf(typeWord, size), static_cast<int>(count)});
        return {};
    }

    Status readPoints() {
        STIPPLE_TRY(width, needInteger("WIDTH"));
        STIPPLE_TRY(height, needInteger("HEIGHT"));
        std::uint64_t product;
        if (__builtin_mul_overflow(width, height, &product))
            return error("WIDTH x HEIGHT is too large");
        header_.points = product;
        if (lines_.count("POINTS") > 0) { // optional in version 0.5
            STIPPLE_TRY(points, needInteger("POINTS"));
            if (points != product)
                return error(cat("POINTS is ", points, ", but WIDTH x HEIGHT is ", product));
        }
        return {};
    }

    Result<std::uint64_t> needInteger(const std::string& keyword) const {
        STIPPLE_TRY(words, need(keyword));
        std::uint64_t value = 0;
        if (words.size() != 1 || !readInteger(words[0], value))
            return error(cat(keyword, " is no number"));
        return value;
    }

    Status readEncoding() {
        STIPPLE_TRY(words, need("DATA"));
        if (words[0] == "ascii")
            header_.encoding = PcdEncoding::ascii;
        else if (words[0] == "binary")
            header_.encoding = PcdEncoding::binary;
        else if (words[0] == "binary_compressed")
            header_.encoding = PcdEncoding::compressed;
        else
            return error(cat("there is no DATA ", words[0].substr(0, 40)));
        return {};
    }

    void readViewpoint() {
        constexpr std::array<double, 7> origin{0, 0, 0, 1, 0, 0, 0};
        const Words& words = lines_["VIEWPOINT"];
        bool isOrigin = words.size() == origin.size();
        for (std::size_t i = 0; i < words.size(); ++i) {
            double value = 0;
            std::from_chars(words[i].data(), words[i].data() + words[i].size(), value);
            isOrigin = isOrigin && value == origin[i];
            header_.viewpoint += (i > 0 ? " " : "") + words[i].substr(0, 40);
        }
        if (isOrigin)
            header_.viewpoint.clear();
    }

    std::string place() const { return cat(source_.name(), ", line ", line_); }
    Error error(const std::string& what) const {
        return {ErrorCode::corrupt, what, place(), "the header is damaged, or of no PCD file"};
    }

    SharedSource& source_;
    FileCursor cursor_;
    PcdHeader header_;
    std::map<std::string, Words> lines_; // by keyword
    std::uint64_t line_ = 0;
};
} // namespace

Result<PcdHeader> readPcdHeader(SharedSource& source) {
    return HeaderReader(source).read();
}

} // namespace stipple
