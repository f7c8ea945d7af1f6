#pragma once
// The table of all fuzz targets.

#include <cstddef>
#include <span>

struct FuzzTarget {
    char const* format; ///< x of x_fuzz.cpp, and of the folder of its seeds
    int (*run)(unsigned char const* data, std::size_t size);
};

std::span<FuzzTarget const> fuzz_targets();
