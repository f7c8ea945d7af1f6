#pragma once
#include "gi/core/sha256.h"
#include "study/script/condition.h"

namespace study {

/// SHA-256 of a stimulus's settings as written in the script: lines "key=value" in the order of settings_of.
inline std::string settings_hash(Patch const& settings)
{
    std::string text;
    for (auto const& [key, value] : settings) text += key + "=" + value + "\n";
    return gi::sha256(text);
}

} // namespace study
