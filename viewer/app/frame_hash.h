#pragma once
#include "gi/core/xxhash.h"
#include "viewer/engine/render_session.h"

namespace viewer {

/// Hash of the colours of all views.
inline std::uint64_t frame_hash(SessionFrame const& frame)
{
    std::uint64_t hash = 0;
    for (ViewPicture const& v : frame.views)
        hash = gi::xxh64(std::as_bytes(std::span(v.picture.find("color")->data)), hash);
    return hash;
}

} // namespace viewer
