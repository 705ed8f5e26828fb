// What options that take numbers refuse, and in which words.
#include "shared/cli/number_check.hpp"

#include <catch2/catch.hpp>

#include <string>

using namespace stipple;

namespace {
// A program of one option, run with one value for it.
struct Answer {
    std::string message; // empty: the value was taken
    std::string value;
};
Answer answerTo(const std::string& value, const CLI::Validator& check, bool changes = false) {
    CLI::App program;
    Answer answer;
    CLI::Option* option = program.add_option("--option", answer.value);
    changes ? option->transform(check) : option->check(check);
    try {
        program.parse(std::vector<std::string>{"--option=" + value});
    } catch (const CLI::ParseError& error) {
        answer.message = error.what();
    }
    return answer;
}
} // namespace

TEST_CASE("a whole number out of its range is told the range", "[cli]") {
    CLI::Validator threads = cli::wholeNumber(1, 1024);
    for (const char* good : {"1", "1024", "+7"})
        CHECK(answerTo(good, threads).message.empty());
    CHECK(answerTo("0", threads).message == "--option: 0 is too small: give a whole number from 1 to 1024");
    CHECK(answerTo("-1", threads).message == "--option: -1 is too small: give a whole number from 1 to 1024");
    CHECK(answerTo("1025", threads).message ==
          "--option: 1025 is too large: give a whole number from 1 to 1024");
    for (const char* far : {"99999999999999999999", "-99999999999999999999"})
        CHECK(answerTo(far, threads).message.find(far[0] == '-' ? "too small" : "too large") !=
              std::string::npos);
    for (const char* bad : {"two", "nan", "inf", "1.5", "1e3", "0x10", "3 ", "-"}) {
        INFO(bad);
        CHECK(answerTo(bad, threads).message.find("is no whole number: give a whole number from 1") !=
              std::string::npos);
    }
}

TEST_CASE("a number must be finite and within its range", "[cli]") {
    CLI::Validator step = cli::numberAbove(0), seconds = cli::number(0.001, 86400);
    for (const char* good : {"0.001", "1e-5", "+2", "86400"}) {
        CHECK(answerTo(good, step).message.empty());
        CHECK((std::string(good) == "1e-5" || answerTo(good, seconds).message.empty()));
    }
    for (const std::string bad : {"0", "-0.0", "-1"})
        CHECK(answerTo(bad, step).message == "--option: " + bad + " is too small: give one greater than 0");
    CHECK(answerTo("86401", seconds).message ==
          "--option: 86401 is too large: give a number from 0.001 to 86400");
    for (const CLI::Validator& check : {step, seconds}) {
        for (const char* bad : {"nan", "-nan", "inf", "-inf", "infinity"}) {
            INFO(bad);
            CHECK(answerTo(bad, check).message.find("is no finite number: give ") != std::string::npos);
        }
        for (const char* bad : {"x", "1,5", "0.5m", "1e999"}) {
            INFO(bad);
            CHECK(answerTo(bad, check).message.find("is no number: give ") != std::string::npos);
        }
    }
}

TEST_CASE("memory is given with a unit, and becomes bytes", "[cli]") {
    CLI::Validator memory = cli::memorySize(std::uint64_t{1} << 26, std::uint64_t{1} << 50);
    for (const char* text : {"64M", "64m", "64MB", "64 MiB", "67108864", "0.0625G", "65536K", "67108864B"}) {
        INFO(text);
        CHECK(answerTo(text, memory, true).value == "67108864");
    }
    CHECK(answerTo("2", memory, true).message ==
          "--option: 2 bytes are too little: give at least 64M, for example 512M or 2G");
    CHECK(answerTo("1M", memory, true).message ==
          "--option: 1M is too little: give at least 64M, for example 512M or 2G");
    CHECK(answerTo("2000T", memory, true).message ==
          "--option: 2000T is more than any machine has: give at most 1024T");
    for (const char* bad : {"G", "much", "nan", "inf", "-1G", "2X", "2GG", "1e400"}) {
        INFO(bad);
        CHECK(answerTo(bad, memory, true).message.find("is no size of memory: give a number with its unit") !=
              std::string::npos);
    }
}
