#include "gi/transport/frame_renderer.h"

#include "gi/base/error.h"

namespace gi {

void FrameRenderer::follow(int) {}

PairResult FrameRenderer::pair(FrameView const&, PairSettings const&, PairWorld const&, StopRequest const&)
{
    throw InputError("pictures with and without what moves, by this method",
                     "it does not know how to give both the same random numbers", "use the method slhb");
}

} // namespace gi
