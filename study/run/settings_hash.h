#pragma once
#include "gi/core/sha256.h"
#include "study/script/condition.h"

namespace study {

/// Of the settings of a stimulus as the script gives them: SHA-256 of lines "key=value" in the order of
/// settings_of.
inline std::string settings_hash(Patch const& settings)
{
    std::string text;
    for (auto const& [key, value] : settings) text += key + "=" + value + "\n";
    return gi::sha256(text);
}

} // namespace study
