// Any text as an experiment: a script or a ScriptError, never anything else. What is a script has a plan, which is
// the same when made again, or is refused with the reason.

#include "study/plan/plan.h"
#include "study/script/script_file.h"

#include <cstdlib>

namespace {

/// Whether a plan is soon made: searches for orders of thousands of trials are left to the tests.
bool is_small(study::Script const& s)
{
    long trials = 0;
    for (study::Block const& b : s.blocks) {
        long conditions = b.repeats;
        for (int const f : b.cross) conditions *= long(s.factors[std::size_t(f)].levels.size());
        for (study::Procedure const& p : b.procedures) conditions += long(b.repeats) * planned_trials(p);
        if (b.pairs) conditions *= long(b.pairs->pairs.size());
        trials += conditions;
        if (conditions > 60 || (!b.constraints.empty() && conditions > 12)) return false;
    }
    return trials <= 100 && s.sequence.size() <= 8;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    std::string const text(reinterpret_cast<char const*>(data), size);
    try {
        study::Script const script = study::parse_script(text, "fuzz");
        if (!is_small(script)) return 0;
        std::string const table = plan_table(script, make_plan(script, 2));
        if (table != plan_table(script, make_plan(script, 2))) std::abort();
    } catch (gi::InputError const& e) {
        if (std::string(e.what()).find('\n') != std::string::npos) std::abort();
    }
    return 0;
}
