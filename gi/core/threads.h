#pragma once
// How many threads a computation uses.

#include <functional>

namespace gi {

/// Number of threads that this process can run at once: cores, as far as its affinity allows them.
int available_threads();

/// Calls `work` with at most `threads` threads for its parallel parts, 0 = all. One TBB arena per thread count is
/// kept for good, because TBB (2021.8) leaks about 7 KB with each arena that ends, which adds up over many frames.
void on_threads(int threads, std::function<void()> const& work);

} // namespace gi
