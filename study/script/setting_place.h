#pragma once
#include "study/script/script_error.h"

namespace study {

/// Where a script gives a setting this value: in `settings`, `with`, a level of a factor, the list of a factor
/// that is named as the setting, or `vary` (then whatever the value is). The first such place; {0, 0}: there is
/// none.
/// @param text  of a script that parse_script takes
Place place_of_setting(std::string const& text, std::string const& key, std::string const& value);

} // namespace study
