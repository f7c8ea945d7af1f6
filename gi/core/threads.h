#pragma once
#include <functional>

namespace gi {

/// Calls work so that what it does in parallel takes so many threads, 0 = all. One arena per number is kept for
/// good: TBB (2021.8) loses about 7 KB with each that ends, which long sequences of frames would notice.
void on_threads(int threads, std::function<void()> const& work);

} // namespace gi
