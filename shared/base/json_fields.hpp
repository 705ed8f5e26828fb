// Reads the fields of a JSON object one by one, each with its type and range, and remembers the first that
// is wrong. What is absent leaves its variable as it is; what nobody asked for is an error at finish().
#pragma once

#include "shared/base/result.hpp"
#include "shared/base/text.hpp"
#include "shared/geometry/vec3.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>

namespace stipple::json_fields {

// Names of an enumeration's values.
template <class T, std::size_t N>
using Names = std::array<std::pair<const char*, T>, N>;

template <class T, std::size_t N>
const char* nameOf(const Names<T, N>& names, T value) {
    for (const auto& [name, named] : names)
        if (named == value)
            return name;
    return "";
}

class FieldReader {
  public:
    using Json = nlohmann::json;

    FieldReader(const Json& object, std::string path) : object_(object), path_(std::move(path)) {
        if (!object_.is_object())
            error_ = Error{ErrorCode::invalidArgument, say("an object {…} is expected"), path_, ""};
    }

    // A field that is read in another way.
    void allow(const char* name) { known_.insert(name); }

    void flag(const char* name, bool& value) {
        if (const Json* field = find(name)) {
            if (!field->is_boolean())
                return fail(name, say("must be true or false"));
            value = field->get<bool>();
        }
    }

    template <class T>
    void number(const char* name, T& value, std::type_identity_t<T> min, std::type_identity_t<T> max) {
        if (const Json* field = find(name)) {
            if (auto read = numberIn<T>(*field, min, max))
                value = *read;
            else
                fail(name, std::is_integral_v<T> ? say("must be a whole number from ", min, " to ", max)
                                                 : say("must be a number from ", min, " to ", max));
        }
    }

    void vector(const char* name, Vec3d& value, double limit) {
        std::array<double, 3> read{value.x, value.y, value.z};
        if (!numbers(name, read, -limit, limit))
            return fail(name, say("must be three numbers [x, y, z]"));
        value = {read[0], read[1], read[2]};
    }

    void bytes(const char* name, std::array<std::uint8_t, 3>& value) {
        std::array<int, 3> read{value[0], value[1], value[2]};
        if (!numbers(name, read, 0, 255))
            return fail(name, say("must be three whole numbers from 0 to 255"));
        for (std::size_t i = 0; i < 3; ++i)
            value[i] = static_cast<std::uint8_t>(read[i]);
    }

    // Of a type with `min` and `max`; null is one that is made of nothing.
    template <class Range>
    void range(const char* name, Range& value) {
        const Json* field = find(name);
        if (field && field->is_null()) {
            value = Range{};
            return;
        }
        std::array<double, 2> read{value.min, value.max};
        if (!numbers(name, read, -1e300, 1e300) || read[0] > read[1])
            return fail(name, say("must be [min, max] with min <= max, or null for the cloud's own range"));
        value = {read[0], read[1]};
    }

    template <class T, std::size_t N>
    void choice(const char* name, T& value, const Names<T, N>& names) {
        const Json* field = find(name);
        if (!field)
            return;
        std::string known;
        for (const auto& [text, named] : names) {
            if (field->is_string() && field->get_ref<const std::string&>() == text) {
                value = named;
                return;
            }
            known += (known.empty() ? "" : ", ") + std::string(text);
        }
        fail(name, say("must be one of ", known));
    }

    void text(const char* name, std::string& value) {
        if (const Json* field = find(name)) {
            if (!field->is_string())
                return fail(name, say("must be a text"));
            value = field->get<std::string>();
        }
    }

    // N numbers; false if the field is absent or wrong (which is remembered).
    template <std::size_t N>
    bool numbersOf(const char* name, std::array<double, N>& values, double limit) {
        if (!find(name))
            return false;
        if (numbers(name, values, -limit, limit))
            return true;
        fail(name, say("must be ", N, " numbers"));
        return false;
    }

    // A number, or null for `open`, which it is too where it is absent.
    void limit(const char* name, double& value, double open) {
        value = open;
        const Json* field = find(name);
        if (!field || field->is_null())
            return;
        if (auto read = numberIn<double>(*field, -1e300, 1e300))
            value = *read;
        else
            fail(name, say("must be a number, or null for none"));
    }

    // A list of at most `most` items, each taken by `take(item, path)`, which answers a Status. False if it
    // is absent.
    template <class Take>
    bool list(const char* name, std::size_t most, Take take) {
        const Json* field = find(name);
        if (!field)
            return false;
        if (!field->is_array() || field->size() > most) {
            fail(name, say("must be a list of at most ", most));
            return true;
        }
        for (std::size_t i = 0; i < field->size() && !error_; ++i)
            if (Status status = take((*field)[i], cat(path_, ".", name, "[", i, "]")); !status.ok())
                error_ = status.error();
        return true;
    }

    // A nested object, read by `read(FieldReader&)`.
    template <class Read>
    void object(const char* name, Read read) {
        if (const Json* field = find(name)) {
            FieldReader inner(*field, path_ + "." + name);
            read(inner);
            if (Status status = inner.finish(); !status.ok() && !error_)
                error_ = status.error();
        }
    }

    void fail(const char* name, Phrase expected) {
        if (!error_)
            error_ = Error{ErrorCode::invalidArgument, say("'", name, "' ", expected), path_, ""};
    }

    Status finish() {
        if (error_)
            return *error_;
        for (const auto& item : object_.items())
            if (!known_.count(item.key()))
                return Error{ErrorCode::invalidArgument, say("there is no field '", item.key(), "'"), path_,
                             say("the fields are ", knownNames())};
        return {};
    }

  private:
    const Json* find(const char* name) {
        known_.insert(name);
        if (error_)
            return nullptr;
        auto at = object_.find(name);
        return at == object_.end() ? nullptr : &*at;
    }

    // False if the field is there, but is not N numbers of that range.
    template <class T, std::size_t N>
    bool numbers(const char* name, std::array<T, N>& values, std::type_identity_t<T> min,
                 std::type_identity_t<T> max) {
        const Json* field = find(name);
        if (!field)
            return true;
        if (!field->is_array() || field->size() != N)
            return false;
        for (std::size_t i = 0; i < N; ++i) {
            auto read = numberIn<T>((*field)[i], min, max);
            if (!read)
                return false;
            values[i] = *read;
        }
        return true;
    }

    template <class T>
    static std::optional<T> numberIn(const Json& field, T min, T max) {
        if (!field.is_number())
            return std::nullopt;
        double value = field.get<double>();
        if (!(value >= static_cast<double>(min) && value <= static_cast<double>(max)))
            return std::nullopt;
        if (std::is_integral_v<T> && value != std::floor(value))
            return std::nullopt;
        return static_cast<T>(value);
    }

    std::string knownNames() const {
        std::string text;
        for (const std::string& name : known_)
            text += (text.empty() ? "" : ", ") + name;
        return text;
    }

    const Json& object_;
    std::string path_;
    std::set<std::string> known_;
    std::optional<Error> error_;
};

} // namespace stipple::json_fields
