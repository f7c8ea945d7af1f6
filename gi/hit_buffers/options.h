#pragma once
// Command-line options of hit buffers and shadow maps.

#include "gi/hit_buffers/settings.h"
#include "gi/render/render_option.h"

namespace gi {

/// Options of hit buffers and shadow maps, for all methods that look up.
RenderOptionTable const& hit_buffer_options();
/// Throws InputError if options contradict each other. @param given  names of those that the user set
void check_hit_buffer_options(std::vector<std::string> const& given, RenderSettings const& settings);

} // namespace gi
