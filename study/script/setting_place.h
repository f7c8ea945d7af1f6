#pragma once
#include "study/script/script_error.h"

namespace study {

/// Returns the first place where a script gives a setting this value: in `settings`, `with`, a level of a factor,
/// the list of a factor named like the setting, or `vary` (for any value); {0, 0} if there is none.
/// @param text  of a script that parse_script accepts
Place place_of_setting(std::string const& text, std::string const& key, std::string const& value);

} // namespace study
