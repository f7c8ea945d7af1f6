#pragma once
// Which pixels of a picture a filter has to find the light of, and which it looks at for that: few of either where
// the light of most is known.

#include "gi/filter/reused_light.h"
#include "gi/filter/spans.h"

namespace gi {

struct FilterArea {
    RowSpans wanted; ///< what a filter has to find
    RowSpans near;   ///< these, and all that it looks at: one pixel around at least

    /// All light that is near but not wanted is known: it is not the filter's to report.
    bool takes = false;

    /// Calls for every span of `near` in a row that is not wanted.
    template <class F>
    void for_known(int y, F const& call) const
    {
        for_between(near[std::size_t(y)], wanted[std::size_t(y)], call);
    }
};

/// All that a picture has of surfaces is wanted: in each row from the first to the last.
FilterArea whole_area(Picture const& picture);

/// Surfaces that take no light from a partner that could tell it are wanted. Sizes may differ.
/// @param reach  of the filter, pixels; as large as the picture and more: everything is near
FilterArea own_area(Picture const& picture, ReusedLight const& taken, int reach);

} // namespace gi
