#include "study/analysis/whole.h"

#include <algorithm>
#include <set>

namespace study {

std::vector<FactorUse> factor_use(Script const& script, std::vector<ObserverTrials> const& observers,
                                  std::vector<ParticipantFactor> const& groups)
{
    std::vector<FactorUse> all;
    for (std::size_t f = 0; f < script.factors.size(); ++f) {
        Factor const& factor = script.factors[f];
        auto const group = std::find_if(groups.begin(), groups.end(),
                                        [&](ParticipantFactor const& g) { return g.name == factor.name; });
        FactorUse use{factor.name, group != groups.end(), {}, {}, 0};
        std::map<int, int> participants; // by level
        for (ObserverTrials const& o : observers) {
            std::set<int> own;
            if (use.is_between) {
                if (auto const level = group->level.find(o.participant); level != group->level.end())
                    own.insert(level->second);
            } else
                for (std::size_t b = 0; b < script.blocks.size(); ++b)
                    for (ObserverTrials const& trials : counted({o}, int(b)))
                        for (TrialRow const& row : trials.rows)
                            own.insert(shared_level(*row.block, row.step->trial, int(f)));
            own.erase(-1);
            for (int const level : own) ++participants[level];
            use.with_several += own.size() > 1;
        }
        if (participants.size() < 2) continue;
        for (auto const& [level, n] : participants) {
            use.levels.push_back(factor.levels[std::size_t(level)].name);
            use.participants.push_back(n);
        }
        all.push_back(std::move(use));
    }
    return all;
}

} // namespace study
