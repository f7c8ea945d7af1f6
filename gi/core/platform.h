#pragma once
// Differences between the host and the CUDA compiler, for headers that both compile.

#if defined(__CUDACC__)
#include <cuda.h> // GLM 0.9.9.8 detects CUDA through CUDA_VERSION, so this precedes every GLM include.
#define GI_FN __host__ __device__
#else
#define GI_FN
#endif
