// What selection and session leave out because it can't show. All of it is left out, unless somebody measures
// what that is worth (`stipple bench`): without a skip the picture stays the same, but for what a budget is
// spent on, and for nodes drawn whole (tooFine), which show exact colours instead of means.
#pragma once

namespace stipple {

struct Skips {
    bool unseen = true;  // nodes outside the view
    bool clipped = true; // nodes that clip boxes hide wholly
    bool hidden =
        true; // clouds of which filters hide every point by their statistics; nodes, once they are here
    bool tooFine = true; // continuous detail: a node's points behind the prefix that can show
    bool unused = true;  // attributes that the style does not use
    friend bool operator==(const Skips&, const Skips&) = default;
};

} // namespace stipple
