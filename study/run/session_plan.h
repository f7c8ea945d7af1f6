#pragma once
// The plan of a session that has begun: the recorded one, whatever this version would plan now.

#include "study/journal/entries.h"
#include "study/plan/plan.h"

#include <filesystem>

namespace study {

struct SessionSettings;

enum class PlanSource {
    same,     ///< this version makes the plan that was recorded
    recorded, ///< plan.tsv; this version makes another one
    assumed,  ///< the recorded plan is lost; nothing in the journal contradicts this one
};

struct SessionPlan {
    Plan plan;
    PlanSource source = PlanSource::same;
    std::string table;  ///< as in plan.tsv
    std::string remark; ///< what differs and what is assumed; empty = nothing
};

/// The plan of a record: plan.tsv in its folder if its hash is that in the journal, else the plan that this
/// version makes if its hash is. If neither is, one that the journal does not contradict.
/// @param record begins with SessionStarted
/// @throws ScriptError if there is none
SessionPlan recorded_plan(Script const& script, SessionRecord const& record, std::filesystem::path const& folder);

/// The plan that run_session will carry out: of the session that it resumes, or a new one.
SessionPlan plan_to_run(Script const& script, int participant, SessionSettings const& settings);

/// The first entry that cannot be of this plan ("trial 12 has ..."); empty = there is none.
std::string contradiction(Script const& script, Plan const& plan, SessionRecord const& record);

} // namespace study
