// A value, or an error that a person can act on. Nothing that reads a disk or a network throws; it
// returns one of these.
#pragma once

#include "shared/base/phrase.hpp"

#include <string>
#include <utility>
#include <variant>

namespace stipple {

// What went wrong, as far as a caller decides differently by it. `notFound`, `changed` and the failures
// stay different things: a thing that is absent is no failure of the disk.
enum class ErrorCode {
    invalidArgument, // the caller asked for something that has no meaning
    notFound,        // the file, cloud or node does not exist
    changed,         // the file is not the version that was opened
    truncated,       // the bytes end before what they promise
    corrupt,         // the bytes contradict themselves or their checksum
    unsupported,     // well-formed, but a version or feature this program does not know
    limitExceeded,   // a stated limit of bytes, items or time would be exceeded
    outOfMemory,     // the machine has no more memory for this process
    outOfRange,      // a value does not fit the type or grid it has to go to
    ioFailed,        // the operating system refused
    writeFailed,     // an output can't be made or written
    networkFailed,   // the connection, or a status that is not an answer
    accessDenied,    // the server wants to know who asks, or has nothing for whoever does
    cancelled,       // the caller took the request back
};

struct Error {
    ErrorCode code = ErrorCode::ioFailed;
    Phrase what;       // what was being done and what went wrong: "the header ends after 12 of 128 bytes"
    std::string where; // file or address, and position: "town.stipple, byte 4096"
    Phrase advice;     // what to do: "convert the scan again"; may be empty
    // networkFailed: the server wants to be left alone for so long (Retry-After); 0: it doesn't say.
    int retryAfterSeconds = 0;

    // One clear sentence or two, for a person: "town.stipple, byte 4096: the header … . Convert the …"
    std::string sentence() const {
        std::string text = where.empty() ? what.text() : where + ": " + what.text();
        if (!advice.empty())
            text += " (" + advice.text() + ")";
        return text;
    }

    // `where`, `what` and `advice` for programs that say it in another language: marked (phrase.hpp), with an
    // RS behind the first two.
    std::string said() const { return where + fieldEnds + what.marked() + fieldEnds + advice.marked(); }
    static constexpr char fieldEnds = '\x1e';

    // The same error, placed: an inner `where` is kept behind the outer one.
    Error at(const std::string& place) const {
        Error placed = *this;
        placed.where = where.empty() ? place : place + ", " + where;
        return placed;
    }
};

// The public name of a code, as --json and tests show it.
const char* errorCodeName(ErrorCode code);

template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }

    T& value() & { return *std::get_if<0>(&state_); }
    const T& value() const& { return *std::get_if<0>(&state_); }
    T&& value() && { return std::move(*std::get_if<0>(&state_)); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(*this).value(); }
    T* operator->() { return std::get_if<0>(&state_); }
    const T* operator->() const { return std::get_if<0>(&state_); }

    const Error& error() const { return *std::get_if<1>(&state_); }

  private:
    std::variant<T, Error> state_;
};

// Success without a value, or an error.
class [[nodiscard]] Status {
  public:
    Status() = default;
    Status(Error error) : state_(std::move(error)) {}
    bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }
    const Error& error() const { return *std::get_if<1>(&state_); }

  private:
    std::variant<std::monostate, Error> state_;
};

} // namespace stipple

#define STIPPLE_JOIN_(a, b) a##b
#define STIPPLE_JOIN(a, b) STIPPLE_JOIN_(a, b)

// Returns the error of `expression` from the enclosing function, if it has one.
#define STIPPLE_CHECK(expression)                                                                            \
    do {                                                                                                     \
        auto stippleStatus = (expression);                                                                   \
        if (!stippleStatus.ok())                                                                             \
            return stippleStatus.error();                                                                    \
    } while (false)

// Declares `name` as the value of `expression`, or returns its error from the enclosing function.
#define STIPPLE_TRY(name, expression)                                                                        \
    auto STIPPLE_JOIN(stippleResult, __LINE__) = (expression);                                               \
    if (!STIPPLE_JOIN(stippleResult, __LINE__).ok())                                                         \
        return STIPPLE_JOIN(stippleResult, __LINE__).error();                                                \
    auto& name = STIPPLE_JOIN(stippleResult, __LINE__).value()
