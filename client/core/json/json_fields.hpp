// Reads the fields of one JSON object into variables, one call a field; keeps the first thing that is
// wrong. A field that is absent leaves its variable as it was. finish() also refuses unknown fields.
#pragma once

#include "shared/base/result.hpp"
#include "shared/base/text.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <string_view>

namespace stipple {

class JsonFields {
  public:
    // `name` says what the object is, for messages: "style".
    static Result<JsonFields> parse(std::string_view text, const std::string& name) {
        auto object = nlohmann::json::parse(text, nullptr, false);
        if (object.is_discarded() || !object.is_object())
            return Error{ErrorCode::invalidArgument, "expected a JSON object such as {\"key\": value}", name,
                         ""};
        return JsonFields(std::move(object), name);
    }

    void boolean(const char* key, bool& value) {
        if (const nlohmann::json* field = find(key)) {
            if (field->is_boolean())
                value = field->get<bool>();
            else
                refuse(key, "must be true or false");
        }
    }

    void number(const char* key, double& value, double least, double most) {
        if (const nlohmann::json* field = find(key))
            takeNumber(key, *field, value, least, most);
    }

    // `most` is at most 2^53, so that a double holds every value.
    template <class T>
    void integer(const char* key, T& value, double least, double most) {
        const nlohmann::json* field = find(key);
        double taken = 0;
        if (!field || !takeNumber(key, *field, taken, least, most))
            return;
        if (taken != std::floor(taken))
            refuse(key, "must be a whole number");
        else
            value = static_cast<T>(taken);
    }

    template <std::size_t N>
    void numbers(const char* key, std::array<double, N>& values, double least, double most) {
        const nlohmann::json* field = find(key);
        if (!field)
            return;
        if (!field->is_array() || field->size() != N)
            return refuse(key, cat("must be an array of ", N, " numbers"));
        for (std::size_t i = 0; i < N; ++i)
            takeNumber(key, (*field)[i], values[i], least, most);
    }

    // An enumeration by the names of its values, in their order.
    template <class Enum, std::size_t N>
    void choice(const char* key, Enum& value, const std::array<const char*, N>& names) {
        const nlohmann::json* field = find(key);
        if (!field)
            return;
        std::string known;
        for (std::size_t i = 0; i < N; ++i) {
            if (field->is_string() && field->get_ref<const std::string&>() == names[i]) {
                value = static_cast<Enum>(i);
                return;
            }
            known += cat(i == 0 ? "" : ", ", names[i]);
        }
        refuse(key, cat("must be one of ", known));
    }

    template <class Read>
    void object(const char* key, Read&& read) {
        const nlohmann::json* field = find(key);
        if (!field)
            return;
        if (!field->is_object())
            return refuse(key, "must be an object");
        JsonFields inner(*field, cat(name_, ".", key));
        read(inner);
        if (Status status = inner.finish(); !status.ok() && !error_)
            error_ = status.error();
    }

    void refuse(const char* key, const std::string& why) {
        if (!error_)
            error_ = Error{ErrorCode::invalidArgument, cat("\"", key, "\" ", why), name_, ""};
    }

    Status finish() const {
        if (error_)
            return *error_;
        for (const auto& item : object_.items())
            if (!asked_.contains(item.key()))
                return Error{ErrorCode::invalidArgument, cat("\"", item.key(), "\" is not known"), name_, ""};
        return {};
    }

  private:
    JsonFields(nlohmann::json object, std::string name)
        : object_(std::move(object)), name_(std::move(name)) {}

    const nlohmann::json* find(const char* key) {
        asked_.insert(key);
        auto field = object_.find(key);
        return field == object_.end() ? nullptr : &*field;
    }

    bool takeNumber(const char* key, const nlohmann::json& field, double& value, double least, double most) {
        if (!field.is_number()) {
            refuse(key, "must be a number");
            return false;
        }
        double taken = field.get<double>();
        if (!(taken >= least && taken <= most)) {
            refuse(key, cat("must be between ", least, " and ", most));
            return false;
        }
        value = taken;
        return true;
    }

    nlohmann::json object_;
    std::string name_;
    std::set<std::string, std::less<>> asked_;
    std::optional<Error> error_;
};

} // namespace stipple
