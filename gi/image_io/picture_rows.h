#pragma once
// A picture that is made while it is read, some rows at a time, so that large
// ones need not be in memory as a whole.

#include "gi/core/progress.h"
#include "gi/image_io/picture.h"

#include <functional>

namespace gi {

/// Rows to read at once: few enough to stay small, many enough for the blocks of OpenEXR (16 rows).
inline constexpr int kRowsAtOnce = 64;

struct PictureRows {
    int width = 0, height = 0;
    /// The same layers for all rows; empty = there is no picture.
    std::function<Picture(int first, int count)> read;
    std::map<std::string, std::string> metadata = {};
    int left = 0, top = 0; ///< corner of the display window

    explicit operator bool() const { return bool(read); }
    /// @param stop  once it is requested, throws Interrupted; null = never
    Picture whole(StopRequest const* stop = nullptr) const;
};

/// The rows of a picture, which must outlive them.
PictureRows rows_of(Picture const& picture);

} // namespace gi
