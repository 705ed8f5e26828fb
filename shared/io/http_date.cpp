#include "shared/io/http_date.hpp"

#include <array>

namespace stipple {

namespace {

constexpr std::array<const char*, 7> dayNames{"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
constexpr std::array<const char*, 7> longDayNames{"Sunday",   "Monday", "Tuesday", "Wednesday",
                                                  "Thursday", "Friday", "Saturday"};
constexpr std::array<const char*, 12> monthNames{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                 "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};

// Days since 1970-01-01 in the proleptic Gregorian calendar; years begin in March, so that the leap day is
// the last of its year and months have a closed formula.
std::int64_t daysFromCivil(std::int64_t year, int month, int day) {
    year -= month <= 2 ? 1 : 0;
    std::int64_t era = (year >= 0 ? year : year - 399) / 400;
    std::int64_t yearOfEra = year - era * 400;
    std::int64_t dayOfYear = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
    return era * 146097 + yearOfEra * 365 + yearOfEra / 4 - yearOfEra / 100 + dayOfYear - 719468;
}

struct Civil {
    int year = 0, month = 0, day = 0;
};

Civil civilFromDays(std::int64_t days) {
    days += 719468;
    std::int64_t era = (days >= 0 ? days : days - 146096) / 146097;
    std::int64_t dayOfEra = days - era * 146097;
    std::int64_t yearOfEra = (dayOfEra - dayOfEra / 1460 + dayOfEra / 36524 - dayOfEra / 146096) / 365;
    std::int64_t dayOfYear = dayOfEra - (365 * yearOfEra + yearOfEra / 4 - yearOfEra / 100);
    std::int64_t shifted = (5 * dayOfYear + 2) / 153; // March = 0
    int day = static_cast<int>(dayOfYear - (153 * shifted + 2) / 5 + 1);
    int month = static_cast<int>(shifted < 10 ? shifted + 3 : shifted - 9);
    return {static_cast<int>(yearOfEra + era * 400 + (month <= 2 ? 1 : 0)), month, day};
}

// A cursor that takes exactly what a date form has at each place.
class DateText {
  public:
    explicit DateText(std::string_view text) : text_(text) {}

    bool take(std::string_view part) {
        bool fits = text_.substr(0, part.size()) == part;
        if (fits)
            text_.remove_prefix(part.size());
        return fits;
    }
    template <std::size_t N>
    int takeName(const std::array<const char*, N>& names) { // index, or -1
        for (std::size_t i = 0; i < N; ++i)
            if (take(names[i]))
                return static_cast<int>(i);
        return -1;
    }
    int takeDigits(int count) { // value, or -1
        int value = 0;
        for (int i = 0; i < count; ++i, text_.remove_prefix(1)) {
            if (text_.empty() || text_.front() < '0' || text_.front() > '9')
                return -1;
            value = value * 10 + (text_.front() - '0');
        }
        return value;
    }
    bool atEnd() const { return text_.empty(); }

  private:
    std::string_view text_;
};

struct Parts {
    int year = -1, month = -1, day = -1, hour = -1, minute = -1, second = -1;
};

bool takeClock(DateText& text, Parts& parts) {
    parts.hour = text.takeDigits(2);
    bool colons = text.take(":");
    parts.minute = text.takeDigits(2);
    colons = text.take(":") && colons;
    parts.second = text.takeDigits(2);
    return colons;
}

bool parseImf(DateText text, Parts& parts) { // Sun, 06 Nov 1994 08:49:37 GMT
    if (text.takeName(dayNames) < 0 || !text.take(", "))
        return false;
    parts.day = text.takeDigits(2);
    bool spaces = text.take(" ");
    parts.month = text.takeName(monthNames) + 1;
    spaces = text.take(" ") && spaces;
    parts.year = text.takeDigits(4);
    return spaces && text.take(" ") && takeClock(text, parts) && text.take(" GMT") && text.atEnd();
}

bool parseRfc850(DateText text, Parts& parts, std::int64_t nowSeconds) { // Sunday, 06-Nov-94 08:49:37 GMT
    if (text.takeName(longDayNames) < 0 || !text.take(", "))
        return false;
    parts.day = text.takeDigits(2);
    bool dashes = text.take("-");
    parts.month = text.takeName(monthNames) + 1;
    dashes = text.take("-") && dashes;
    int twoDigits = text.takeDigits(2);
    if (!dashes || twoDigits < 0)
        return false;
    int thisYear = civilFromDays(nowSeconds / 86400).year;
    parts.year = thisYear - thisYear % 100 + twoDigits;
    if (parts.year > thisYear + 50)
        parts.year -= 100;
    return text.take(" ") && takeClock(text, parts) && text.take(" GMT") && text.atEnd();
}

bool parseAsctime(DateText text, Parts& parts) { // Sun Nov  6 08:49:37 1994
    if (text.takeName(dayNames) < 0 || !text.take(" "))
        return false;
    parts.month = text.takeName(monthNames) + 1;
    bool spaces = text.take(" ");
    parts.day = text.take(" ") ? text.takeDigits(1) : text.takeDigits(2);
    spaces = text.take(" ") && spaces && takeClock(text, parts) && text.take(" ");
    parts.year = text.takeDigits(4);
    return spaces && text.atEnd();
}

} // namespace

std::string httpDate(std::int64_t seconds) {
    std::int64_t days = seconds >= 0 ? seconds / 86400 : (seconds - 86399) / 86400;
    int ofDay = static_cast<int>(seconds - days * 86400);
    Civil date = civilFromDays(days);
    int weekday = static_cast<int>(((days + 4) % 7 + 7) % 7); // 1970-01-01 was a Thursday
    // Two of these stand in every answer; snprintf would take a tenth of its time.
    std::string text = "Sun, 06 Nov 1994 08:49:37 GMT";
    auto putName = [&](std::size_t at, const char* name) { text.replace(at, 3, name); };
    auto putDigits = [&](std::size_t end, int value, int count) {
        for (; count > 0; --count, value /= 10)
            text[--end] = static_cast<char>('0' + value % 10);
    };
    putName(0, dayNames[static_cast<std::size_t>(weekday)]);
    putDigits(7, date.day, 2);
    putName(8, monthNames[static_cast<std::size_t>(date.month - 1)]);
    putDigits(16, date.year, 4);
    putDigits(19, ofDay / 3600, 2);
    putDigits(22, ofDay / 60 % 60, 2);
    putDigits(25, ofDay % 60, 2);
    return text;
}

std::optional<std::int64_t> parseHttpDate(std::string_view text, std::int64_t nowSeconds) {
    Parts parts;
    if (!parseImf(DateText(text), parts) && !parseRfc850(DateText(text), parts, nowSeconds) &&
        !parseAsctime(DateText(text), parts))
        return std::nullopt;
    bool valid = parts.year >= 0 && parts.month >= 1 && parts.day >= 1 && parts.day <= 31 &&
                 parts.hour >= 0 && parts.hour <= 23 && parts.minute >= 0 && parts.minute <= 59 &&
                 parts.second >= 0 && parts.second <= 60; // 60: a leap second
    if (!valid)
        return std::nullopt;
    return daysFromCivil(parts.year, parts.month, parts.day) * 86400 + parts.hour * 3600 + parts.minute * 60 +
           parts.second;
}

} // namespace stipple
