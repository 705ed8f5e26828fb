#include "tests/golden/scene.hpp"

#include "client/core/json.hpp"
#include "shared/base/text.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace stipple::golden {
namespace {

Error sceneError(const std::string& path, const std::string& what) {
    return {ErrorCode::invalidArgument, what, path, ""};
}

} // namespace

Result<Scene> readScene(const std::string& folder) {
    std::string path = folder + "/scene.json";
    std::ifstream file(path);
    if (!file)
        return Error{ErrorCode::notFound, "there is no scene", path, ""};
    std::string text((std::istreambuf_iterator<char>(file)), {});
    STIPPLE_TRY(json, parseJson(text, path));
    if (!json.is_object())
        return sceneError(path, "an object is expected");
    for (const auto& item : json.items())
        if (item.key() != "about" && item.key() != "cloud" && item.key() != "view" &&
            item.key() != "projection" && item.key() != "style" && item.key() != "size" &&
            item.key() != "budget")
            return sceneError(path, cat("there is no field '", item.key(), "'"));
    auto size = json.value("size", nlohmann::json());
    auto budget = json.value("budget", nlohmann::json());
    auto view = json.value("view", nlohmann::json());
    bool usable = json.contains("cloud") && json["cloud"].is_object() && size.is_array() &&
                  size.size() == 2 && size[0].is_number_integer() && size[1].is_number_integer() &&
                  budget.is_number_unsigned() && (view.is_string() || view.is_object());
    if (!usable)
        return sceneError(path, "cloud {…}, view, size [w, h] and budget are needed");

    Scene scene;
    scene.folder = folder;
    scene.name = std::filesystem::path(folder).filename().string();
    scene.cloud = json["cloud"];
    scene.request.width = size[0].get<int>();
    scene.request.height = size[1].get<int>();
    scene.request.limits.pointBudget = budget.get<std::uint64_t>();
    scene.request.view = view.is_string() ? view.get<std::string>() : jsonText(view);
    if (json.contains("projection"))
        scene.request.projection =
            json["projection"] == "orthographic" ? Projection::orthographic : Projection::perspective;
    auto style = styleFromJson(json.value("style", nlohmann::json::object()));
    if (!style.ok())
        return style.error().at(path);
    scene.request.style = *style;
    Status checked = checkRequest(scene.request);
    if (!checked.ok())
        return checked.error().at(path);
    return scene;
}

} // namespace stipple::golden
