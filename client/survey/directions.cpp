#include "client/survey/directions.hpp"

#include <cmath>

namespace stipple::survey {

namespace {

// Latitude and height by iteration (Hofmann-Wellenhof et al., "Global Positioning System", §10.2.1): each
// step takes some three digits of the error away.
double geodeticLatitude(double fromAxis, double z, const Ellipsoid& ellipsoid) {
    double flattening = 1 / ellipsoid.inverseFlattening;
    double e2 = flattening * (2 - flattening);
    double latitude = std::atan2(z, fromAxis * (1 - e2));
    for (int i = 0; i < 12; ++i) {
        double sine = std::sin(latitude);
        double n = ellipsoid.semiMajor / std::sqrt(1 - e2 * sine * sine);
        latitude = std::atan2(z + e2 * n * sine, fromAxis);
    }
    return latitude;
}

} // namespace

Directions geocentricDirections(Vec3d place, const Ellipsoid& ellipsoid) {
    double fromAxis = std::hypot(place.x, place.y);
    double latitude = geodeticLatitude(fromAxis, place.z, ellipsoid);
    double cosine = fromAxis > 0 ? place.x / fromAxis : 1, sine = fromAxis > 0 ? place.y / fromAxis : 0;
    double up = std::sin(latitude), out = std::cos(latitude);
    return {{out * cosine, out * sine, up}, {-up * cosine, -up * sine, out}};
}

} // namespace stipple::survey
