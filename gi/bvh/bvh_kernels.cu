#include "gi/bvh/build_kernels.h"
#include "gi/bvh/trace_rays.h"
#include "gi/kernel/launch.cuh"

namespace gi {

template void launch_device(char const*, std::size_t, FindBoxes const&);
template void launch_device(char const*, std::size_t, FindKeys const&);
template void launch_device(char const*, std::size_t, StartClusters const&);
template void launch_device(char const*, std::size_t, FindNeighbours const&);
template void launch_device(char const*, std::size_t, MarkPairs const&);
template void launch_device(char const*, std::size_t, JoinPairs const&);
template void launch_device(char const*, std::size_t, FindCuts const&);
template void launch_device(char const*, std::size_t, ChooseChildren const&);
template void launch_device(char const*, std::size_t, WriteNodes const&);
template void launch_device(char const*, std::size_t, RefitLeaves const&);
template void launch_device(char const*, std::size_t, RefitNodes const&);
template void launch_device(char const*, std::size_t, TraceRays<false> const&);
template void launch_device(char const*, std::size_t, TraceRays<true> const&);

} // namespace gi
