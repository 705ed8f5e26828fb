#include "server/http/negotiation.hpp"

#include <array>
#include <catch2/catch.hpp>

using namespace stipple::server;

namespace {

constexpr std::array offers{Format{"json", "application/json", "json"}, Format{"csv", "text/csv", "csv"},
                            Format{"las", "application/vnd.las", "las"}};

std::string accepted(std::string_view accept) {
    auto index = acceptedFormat(accept, offers);
    return index ? std::string(offers[*index].name) : "none";
}

} // namespace

TEST_CASE("without a wish the first format is given") {
    CHECK(accepted("") == "json");
    CHECK(accepted("*/*") == "json");
    CHECK(accepted("  ") == "json");
    CHECK(accepted(",,") == "json");
    CHECK(accepted("text/html,application/xhtml+xml,*/*;q=0.8") == "json");
}

TEST_CASE("the highest quality wins, then the order of the offers") {
    CHECK(accepted("text/csv") == "csv");
    CHECK(accepted("TEXT/CSV") == "csv");
    CHECK(accepted("application/json;q=0.3, text/csv;q=0.5") == "csv");
    CHECK(accepted("application/json;q=0.5, text/csv;q=0.5") == "json");
    CHECK(accepted("text/csv, application/json") == "json");
    CHECK(accepted("application/json;q=0.999,application/vnd.las;q=1.000") == "las");
    CHECK(accepted("text/csv;header=present;q=0.9, application/json;q=0.1") == "csv");
}

TEST_CASE("the most specific range counts for a format") {
    CHECK(accepted("*/*, application/json;q=0.1") == "csv");
    CHECK(accepted("application/*;q=0.2, application/vnd.las, */*;q=0.1") == "las");
    CHECK(accepted("text/*") == "csv");
    CHECK(accepted("text/*;q=0.4, */*;q=0.3") == "csv");
    CHECK(accepted("application/json;q=0, */*;q=0.5") == "csv");
}

TEST_CASE("what is refused or not named is not given") {
    CHECK(accepted("image/png") == "none");
    CHECK(accepted("*/*;q=0") == "none");
    CHECK(accepted("text/csv;q=0.0, image/*") == "none");
}

TEST_CASE("elements that can't be read are passed over") {
    CHECK(accepted("text/csv;q=2, application/json;q=0.1") == "json");
    CHECK(accepted("text/csv;q=abc, application/vnd.las") == "las");
    CHECK(accepted("csv, application/vnd.las") == "las");
    CHECK(accepted("a/b;x=\"text/csv, text/csv\", application/vnd.las;q=0.1") == "las");
    CHECK(accepted("\"") == "json");
    CHECK(accepted("a/b;x=\"\\") == "none");
}

TEST_CASE("a name of a format goes before the field Accept") {
    HttpRequest request{"GET", "/", 11, {{"Accept", "application/json"}}};
    auto named = std::get<ChosenFormat>(chooseFormat(request, "csv", offers));
    CHECK(named.format->name == "csv");
    CHECK_FALSE(named.variesByAccept);
    auto accepted = std::get<ChosenFormat>(chooseFormat(request, "", offers));
    CHECK(accepted.format->name == "json");
    CHECK(accepted.variesByAccept);
}

TEST_CASE("a format that there is not is refused with those that there are") {
    HttpRequest request{"GET", "/", 11, {{"Accept", "image/png"}}};
    auto unknown = std::get<HttpResponse>(chooseFormat(request, "tiff", offers));
    CHECK(unknown.status == 400);
    CHECK(std::get<std::string>(unknown.body.front()).find("json, csv, las") != std::string::npos);
    auto refused = std::get<HttpResponse>(chooseFormat(request, "", offers));
    CHECK(refused.status == 406);
    CHECK(refused.field("Vary") == "Accept");
    CHECK(std::get<std::string>(refused.body.front())
              .find("\"available\":[\"application/json\",\"text/csv\",\"application/vnd.las\"]") !=
          std::string::npos);
}
