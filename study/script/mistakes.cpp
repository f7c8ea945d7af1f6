#include "study/script/mistakes.h"

#include "study/script/keys.h"

namespace study {

void Mistakes::check_keys(gi::Yaml const& map, char const* kind)
{
    auto const& known = script_keys().at(kind);
    gi::Mistakes::check_keys(map, {known.begin(), known.end()});
}

std::vector<ScriptError> Mistakes::in_order() const
{
    auto const all = gi::Mistakes::in_order();
    return {all.begin(), all.end()};
}

} // namespace study
