#pragma once
// Everything that is wrong with a script. Parsing continues after a mistake, so that all are reported at once.

#include "gi/core/mistakes.h"
#include "study/script/script_error.h"

namespace study {

class Mistakes : public gi::Mistakes {
public:
    /// As attempt(), for parts that others do not need: a mistake in them does not count as grave.
    template <class Read>
    bool attempt_aside(Read const& read)
    {
        bool const is_fine = attempt(read);
        aside_ += !is_fine;
        return is_fine;
    }
    /// Keys that do not belong to this kind of mapping (study/script/keys.h).
    void check_keys(gi::Yaml const& map, char const* kind);

    std::size_t grave() const { return count() - aside_; }
    /// In the order of the script, each once.
    std::vector<ScriptError> in_order() const;

private:
    std::size_t aside_ = 0;
};

} // namespace study
