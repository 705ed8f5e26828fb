// The page: static files of one folder, or a built-in text where the page has not been built. Thread: any.
#pragma once

#include "server/files/root_folder.hpp"
#include "server/http/message.hpp"
#include "server/http/target.hpp"

#include <memory>

namespace stipple::server {

class Page {
  public:
    explicit Page(std::unique_ptr<RootFolder> folder) : folder_(std::move(folder)) {} // null: not built

    // A GET or HEAD. "/" is index.html. Names that carry a hash of their content (Vite's
    // assets/NAME-HASH.EXT) are immutable; everything else is revalidated on each use.
    HttpResponse answer(const HttpRequest& request, const Target& target, std::int64_t nowSeconds) const;

  private:
    std::unique_ptr<RootFolder> folder_;
};

// True for "assets/index-B3x_9aQz.js".
bool isHashedAsset(std::string_view relativePath);

// The folder of the built page: `chosen` if not empty; else ../share/stipple/www beside the program, else
// www/dist of the source tree it was built from. Null where there is none; an error if `chosen` is none.
Result<std::unique_ptr<RootFolder>> openPageFolder(const std::string& chosen);

} // namespace stipple::server
