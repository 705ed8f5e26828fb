// Which of several formats a client gets (RFC 9110 §12.5.1). Pure.
#pragma once

#include "server/http/message.hpp"

#include <array>
#include <optional>
#include <span>
#include <string_view>

namespace stipple::server {

// A format that an endpoint can answer in.
struct Format {
    std::string_view name;      // as `?format=` takes it: "csv"
    std::string_view mediaType; // lower case, without parameters: "text/csv"
    std::string_view extension; // of files that hold it: "csv"
};

template <std::size_t N>
constexpr std::array<std::string_view, N> namesOf(const std::array<Format, N>& formats) {
    std::array<std::string_view, N> names;
    for (std::size_t i = 0; i < N; ++i)
        names[i] = formats[i].name;
    return names;
}

// Index of the offer that the value of Accept wants most: of the offers with the highest quality the first.
// For each offer its most specific media range counts; a quality of 0 refuses it. Parameters other than q
// are passed over, and so are elements that can't be read. Nothing if every offer is refused or none is
// named. `accept` without elements: the first.
std::optional<std::size_t> acceptedFormat(std::string_view accept, std::span<const Format> offers);

// `name` (of `?format=`; empty: none was given) goes before the field Accept. A response is the refusal: 400
// for a name that is none of the offers', 406 with what there is.
struct ChosenFormat {
    const Format* format = nullptr;
    bool variesByAccept = false; // the response needs `Vary: Accept`
};
std::variant<ChosenFormat, HttpResponse> chooseFormat(const HttpRequest& request, std::string_view name,
                                                      std::span<const Format> offers);

} // namespace stipple::server
