#pragma once
#include "viewer/offline/render_options.h"

namespace viewer {

/// Throws InputError if options are given that none of the methods of a sweep ("slhb:streamed", "vpl_ao:0.5")
/// uses.
void check_sweep_methods(CLI::App const& command, RenderOptions const& options,
                         std::vector<std::string> const& names);

} // namespace viewer
