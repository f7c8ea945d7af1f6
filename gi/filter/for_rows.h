#pragma once
// A parallel loop over the rows of a picture, which can be stopped.

#include "gi/core/progress.h"

#include <tbb/parallel_for.h>

namespace gi {

/// Calls work(y) for all rows of a picture, in parallel. Throws Interrupted once
/// a stop is requested; null = never.
template <class F>
void for_rows(int height, StopRequest const* stop, F const& work)
{
    tbb::parallel_for(0, height, [&](int y) {
        if (stop != nullptr && stop->requested()) throw Interrupted();
        work(y);
    });
}

} // namespace gi
