#include "server/api/image_endpoint.hpp"

#include "server/api/image_request.hpp"
#include "server/api/picture_service.hpp"
#include "server/http/problem.hpp"
#include "shared/base/text.hpp"

namespace stipple::server {

namespace {

HttpResponse pictureResponse(const Format& format, const Validity& validity, const std::string& picture) {
    HttpResponse response;
    response.set("Content-Type", std::string(format.mediaType));
    validity.setFields(response);
    response.body.push_back(picture);
    return response;
}

} // namespace

Answer answerImage(const ApiCall& call) {
    auto request = imageRequestOf(call.query);
    if (!request)
        return parameterProblem(request.error());
    const std::string* name = call.query.find(image_parameters::format.name);
    auto chosen = chooseFormat(call.request, name ? *name : "", imageFormats);
    if (auto* refusal = std::get_if<HttpResponse>(&chosen))
        return *refusal;
    auto [format, variesByAccept] = std::get<ChosenFormat>(chosen);

    std::string variant = cat("image ", format->name, " ", canonicalText(*request));
    Validity validity = validityOf(call, variant, variesByAccept);
    if (validity.conditional)
        return *validity.conditional;
    PictureService& pictures = call.resources.pictures();
    std::string key = keptKeyOf(call, variant);
    if (auto picture = pictures.kept(key))
        return pictureResponse(*format, validity, *picture);
    return Job{"image",
               [cloud = call.cloud, request = *request, format = format, validity, key,
                &pictures](AnswerWriter& writer) -> Status {
                   STIPPLE_TRY(picture,
                               pictures.picture(key, cloud, request, format->name, writer.isStopped()));
                   writer.answer(pictureResponse(*format, validity, *picture));
                   return {};
               },
               call.resources.pictureRate};
}

} // namespace stipple::server
