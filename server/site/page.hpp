// The page: static files of one folder, or a built-in text where the page has not been built. Thread: any.
#pragma once

#include "server/files/root_folder.hpp"
#include "server/http/message.hpp"
#include "server/http/target.hpp"

#include <memory>
#include <optional>
#include <string>

namespace stipple::server {

class Page {
  public:
    explicit Page(std::unique_ptr<RootFolder> folder) : folder_(std::move(folder)) {} // null: not built

    // A GET or HEAD. "/" is index.html. Names that carry a hash of their content (Vite's
    // assets/NAME-HASH.EXT) are immutable; everything else is revalidated on each use. A file that lies there
    // coded, too (app.js.br beside app.js, at least as new), is sent in the coding that the client likes
    // best, with a tag of its own; 406 if it refuses every one there is.
    HttpResponse answer(const HttpRequest& request, const Target& target, std::int64_t nowSeconds) const;

  private:
    HttpResponse answerFile(const HttpRequest& request, const std::string& path,
                            std::int64_t nowSeconds) const;

    std::unique_ptr<RootFolder> folder_;
};

// The file of `folder` that a request gets for `path`: itself, or coded. Errors: those of RootFolder;
// unsupported if the client refuses all there are.
struct ChosenFile {
    std::shared_ptr<const OpenFile> file;
    std::string coding; // empty: as it is
};
Result<ChosenFile> chooseCoding(const RootFolder& folder, const std::string& path,
                                const std::optional<std::string>& acceptEncoding);

// True for "assets/index-B3x_9aQz.js".
bool isHashedAsset(std::string_view relativePath);

// The folder of the built page: `chosen` if not empty; else ../share/stipple/www beside the program, else
// www/dist of the source tree it was built from. Null where there is none; an error if `chosen` is none.
Result<std::unique_ptr<RootFolder>> openPageFolder(const std::string& chosen);

} // namespace stipple::server
