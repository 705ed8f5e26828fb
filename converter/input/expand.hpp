// What a user names as inputs, to files.
#pragma once

#include "shared/base/result.hpp"

#include <string>
#include <vector>

namespace stipple {

struct ExpandedInputs {
    std::vector<std::string> paths;    // in the order of the arguments; those of one argument sorted by bytes
    std::vector<std::string> warnings; // what a folder or pattern held and is left out, a sentence each
};

// Each argument is one of these, tried in this order:
//
// * A file, as it is, whatever its name; one that does not exist too, if its name is no pattern, so that
// opening
//   it says what is wrong.
// * A folder: every scan in it and in the folders below it, told by content (inputKindOf). Left out: names
// that
//   begin with a dot, links to folders, files of other kinds, and .stipple files, which are mostly made
//   of the scans beside them.
// * A pattern (input/glob.hpp; `**` is any number of folders, none too): the files that fit, of whatever
// kind.
//
// `output`, the file that is going to be written, is no input where a folder or a pattern holds it ("": there
// is none). A file that several folders or patterns lead to is taken once; what links to it, by another name,
// is named in a warning.
//
// Errors: notFound (a pattern that nothing fits, a folder without scans), ioFailed (a folder that can't be
// read). Holds no file open.
Result<ExpandedInputs> expandInputs(const std::vector<std::string>& arguments, const std::string& output);

} // namespace stipple
