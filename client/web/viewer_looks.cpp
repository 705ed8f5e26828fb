// The viewer's style, and what is counted to choose one.
#include "client/web/viewer.hpp"

#include "client/core/gradients.hpp"
#include "client/core/json.hpp"

#include <nlohmann/json.hpp>

#include <utility>

namespace stipple::web {
namespace {

constexpr std::uint64_t pointsCountedAtOnce = 100'000; // a few milliseconds
constexpr int shownGradientStops = 64;

} // namespace

Status Viewer::setStyle(std::string_view json) {
    STIPPLE_TRY(style, styleFromJson(json, session_->style()));
    session_->setStyle(style);
    return {};
}

std::string Viewer::styleJson() const {
    return jsonText(toJson(session_->style()));
}

Status Viewer::count(std::string_view json) {
    STIPPLE_TRY(requests, histogramRequestsFromJson(json));
    session_->watchAttributes(attributesOf(requests));
    counter_.reset();
    if (!requests.empty())
        counter_.emplace(session_->countedView(), std::move(requests));
    return {};
}

std::string Viewer::takeCountsJson() {
    if (!counter_)
        return jsonText({{"pending", false}});
    if (!counter_->advance(pointsCountedAtOnce))
        return jsonText({{"pending", true}});
    nlohmann::json counts = toJson(counter_->counts());
    counter_.reset();
    return jsonText({{"pending", false}, {"counts", std::move(counts)}});
}

std::string Viewer::jsonOf(const Style& style) {
    return jsonText(toJson(style));
}

std::string Viewer::gradientsJson() {
    nlohmann::json gradients = nlohmann::json::object();
    for (GradientName name : {GradientName::viridis, GradientName::turbo, GradientName::inferno,
                              GradientName::spectral, GradientName::grey, GradientName::terrain}) {
        nlohmann::json colours = nlohmann::json::array();
        for (int i = 0; i < shownGradientStops; ++i) {
            auto entry = static_cast<std::size_t>(i * (gradientEntries - 1) / (shownGradientStops - 1));
            std::uint32_t word = gradientTable(name)[entry];
            colours.push_back({word & 255, word >> 8 & 255, word >> 16 & 255});
        }
        gradients[gradientNameText(name)] = {{"colours", std::move(colours)},
                                             {"isColourBlindSafe", isColourBlindSafe(name)}};
    }
    return jsonText(gradients);
}

} // namespace stipple::web
