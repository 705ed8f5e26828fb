// Certificates for tests, made by the openssl command.
#pragma once

#include <filesystem>
#include <string>

namespace stipple::test {

struct TestCertificate {
    std::string certificatePath, keyPath;
};

// A fresh key, and a certificate for `name` (localhost and 127.0.0.1 are its alternative names) that signs
// itself. Fails the test if openssl can't be run.
TestCertificate makeCertificate(const std::filesystem::path& folder, const std::string& name);

// Runs `openssl ARGUMENTS`; fails the test if that fails.
void runOpenSsl(const std::string& arguments);

} // namespace stipple::test
