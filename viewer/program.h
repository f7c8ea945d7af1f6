#pragma once

namespace viewer {

/// The whole command line. Exit codes: 0 done, 1 a comparison failed or something broke inside, 2 the input or the
/// call is wrong, 130 interrupted (what was done so far is kept).
int run_program(int argc, char const* const* argv);

} // namespace viewer
