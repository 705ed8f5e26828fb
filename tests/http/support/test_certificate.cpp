#include "tests/http/support/test_certificate.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>

namespace stipple::test {

void runOpenSsl(const std::string& arguments) {
    INFO("openssl " << arguments);
    REQUIRE(std::system(("openssl " + arguments + " >/dev/null 2>&1").c_str()) == 0);
}

TestCertificate makeCertificate(const std::filesystem::path& folder, const std::string& name) {
    TestCertificate made{(folder / (name + ".crt")).string(), (folder / (name + ".key")).string()};
    runOpenSsl("req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2 -subj /CN=" + name +
               " -addext subjectAltName=DNS:localhost,IP:127.0.0.1 -keyout " + made.keyPath + " -out " +
               made.certificatePath);
    return made;
}

} // namespace stipple::test
