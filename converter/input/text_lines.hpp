// A text file as blocks of whole lines, each line ended by '\n'.
#pragma once

#include "converter/input/shared_source.hpp"

namespace stipple {

class TextLines {
  public:
    static constexpr std::size_t longestLine = std::size_t{1} << 20;

    // From byte `offset`, which begins line number `line`.
    TextLines(SharedSource& source, std::uint64_t offset, std::uint64_t line)
        : source_(source), fileOffset_(offset), line_(line) {}

    // Makes at() point at the next line, which ends with '\n' (added where the file's last line has none).
    // Returns false at the end of the file. Lines that end with '\r' alone are lines as well. Errors: a line
    // longer than `longestLine`, a file that can't be read.
    Result<bool> load();
    const char* at() const { return at_; }
    // `end` is behind the '\n' of the line at at().
    void pass(const char* end) {
        at_ = end;
        ++line_;
    }
    std::uint64_t line() const { return line_; } // number of the line at at(), from 1
    std::uint64_t offset() const {               // byte of the file that at() is
        return fileOffset_ - static_cast<std::uint64_t>(end_ - at_);
    }
    std::string place() const; // "FILE, line 12"

  private:
    Result<bool> refill();

    SharedSource& source_;
    std::uint64_t fileOffset_; // of the first byte behind the block
    std::uint64_t line_;
    std::string block_; // whole lines, then the start of another
    const char *at_ = nullptr, *linesEnd_ = nullptr, *end_ = nullptr; // in block_; end_: of what the file has
};

} // namespace stipple
