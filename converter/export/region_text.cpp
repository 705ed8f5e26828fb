#include "converter/export/region_text.hpp"

#include "converter/export/filter_text.hpp"
#include "shared/base/text.hpp"
#include "shared/geometry/exact_sum.hpp"

#include <charconv>

namespace stipple {

namespace {

bool isLetter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool isSpace(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

class WktReader {
  public:
    WktReader(std::string_view text, const std::string& what) : text_(text), what_(what) {}

    Result<GeoJsonRegion> read() {
        std::string type = word();
        if (type != "POLYGON" && type != "MULTIPOLYGON")
            return fail(cat("\"", type, "\" has no area"), "give POLYGON or MULTIPOLYGON");
        std::string next = word();
        if (next == "Z" || next == "M" || next == "ZM")
            next = word();
        if (next == "EMPTY")
            return fail("there is no polygon in it");
        if (!next.empty())
            return fail(cat("\"", next, "\" is not expected"));
        std::vector<Polygon> polygons;
        auto readOne = [&]() -> Status {
            STIPPLE_TRY(polygon, readPolygon());
            polygons.push_back(std::move(polygon));
            return {};
        };
        STIPPLE_CHECK(type == "POLYGON" ? readOne() : readList(readOne));
        skipSpace();
        if (at_ != text_.size())
            return fail("there is more behind it");
        return GeoJsonRegion{std::make_shared<PolygonRegion>(std::move(polygons)), ""};
    }

  private:
    Error fail(std::string what, std::string advice = "") const {
        return {ErrorCode::invalidArgument, std::move(what), cat(what_, ", character ", at_ + 1),
                std::move(advice)};
    }

    void skipSpace() {
        while (at_ < text_.size() && isSpace(text_[at_]))
            ++at_;
    }
    bool takes(char c) {
        skipSpace();
        if (at_ == text_.size() || text_[at_] != c)
            return false;
        ++at_;
        return true;
    }
    // In upper case; empty if there is none.
    std::string word() {
        skipSpace();
        std::string word;
        for (; at_ < text_.size() && isLetter(text_[at_]); ++at_)
            word += static_cast<char>(text_[at_] & ~0x20);
        return word;
    }

    // "(one, one, …)"
    template <class ReadOne>
    Status readList(ReadOne readOne) {
        if (!takes('('))
            return fail("a ( is expected");
        do
            STIPPLE_CHECK(readOne());
        while (takes(','));
        return takes(')') ? Status() : Status(fail("a , or ) is expected"));
    }

    Result<Polygon> readPolygon() {
        std::vector<Ring> rings;
        auto readOne = [&]() -> Status {
            STIPPLE_TRY(points, readRing());
            rings.emplace_back(std::move(points));
            return {};
        };
        STIPPLE_CHECK(readList(readOne));
        Ring outer = std::move(rings.front());
        rings.erase(rings.begin());
        return Polygon{std::move(outer), std::move(rings)};
    }

    Result<std::vector<Point2d>> readRing() {
        std::vector<Point2d> points;
        auto readOne = [&]() -> Status {
            STIPPLE_TRY(point, readPoint());
            points.push_back(point);
            return {};
        };
        STIPPLE_CHECK(readList(readOne));
        if (points.size() < 4)
            return fail(cat("a ring has at least four points, this one has ", points.size()),
                        "the last repeats the first");
        if (points.front() != points.back())
            return fail("the ring is not closed", "the last point repeats the first");
        return points;
    }

    // Two to four numbers, of which the first two count.
    Result<Point2d> readPoint() {
        STIPPLE_TRY(x, readNumber());
        STIPPLE_TRY(y, readNumber());
        for (int more = 0; more < 2; ++more) {
            skipSpace();
            if (at_ == text_.size() || text_[at_] == ',' || text_[at_] == ')')
                break;
            STIPPLE_TRY(ignored, readNumber());
            static_cast<void>(ignored);
        }
        return Point2d{x, y};
    }

    Result<double> readNumber() {
        skipSpace();
        double value = 0;
        const char* begin = text_.data() + at_;
        auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
        if (error != std::errc() || !isExactlySummable(value))
            return fail("a coordinate is expected");
        at_ += static_cast<std::size_t>(end - begin);
        return value;
    }

    std::string_view text_;
    const std::string& what_;
    std::size_t at_ = 0;
};

Result<GeoJsonRegion> regionOfCorners(std::string_view text, const std::string& what) {
    auto corners = lineFromText(text);
    if (!corners)
        return Error{ErrorCode::invalidArgument, corners.error().what, what,
                     "give GeoJSON, well-known text, or corners as x,y;x,y;…"};
    std::size_t count = corners->size() - (corners->front() == corners->back() ? 1 : 0);
    if (count < 3)
        return Error{ErrorCode::invalidArgument,
                     cat("a polygon has at least three corners, this one has ", count), what, ""};
    for (Point2d corner : *corners)
        if (!isExactlySummable(corner.x) || !isExactlySummable(corner.y))
            return Error{ErrorCode::invalidArgument, "a corner is out of range", what, ""};
    std::vector<Polygon> polygons;
    polygons.push_back({Ring(*std::move(corners)), {}});
    return GeoJsonRegion{std::make_shared<PolygonRegion>(std::move(polygons)), ""};
}

} // namespace

Result<GeoJsonRegion> regionFromText(std::string_view text, const std::string& what) {
    std::string_view start = text;
    while (!start.empty() && isSpace(start.front()))
        start.remove_prefix(1);
    if (start.starts_with('{'))
        return parseGeoJson(text, what);
    if (!start.empty() && isLetter(start.front()))
        return WktReader(text, what).read();
    return regionOfCorners(text, what);
}

} // namespace stipple
