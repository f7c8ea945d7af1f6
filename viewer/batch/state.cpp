#include "viewer/batch/state.h"

#include "viewer/batch/claim.h"

#include <algorithm>

namespace viewer::batch {

BatchState state_of(Store const& store, Batch const& batch)
{
    BatchState s;
    s.tasks.resize(batch.tasks.size());
    std::map<std::string_view, std::size_t> by_key;
    for (std::size_t i = 0; i < batch.tasks.size(); ++i) by_key.emplace(batch.tasks[i].key, i);
    TaskJournalReader reader(store.journal());
    for (Event& event : reader.read()) {
        auto const found = by_key.find(event.task);
        if (found == by_key.end()) continue;
        TaskView& task = s.tasks[found->second];
        task.starts += event.kind == EventKind::started;
        if (event.at_s >= task.last.at_s) task.last = std::move(event);
    }
    s.damaged_lines = reader.damaged();
    for (std::size_t i = 0; i < s.tasks.size(); ++i) {
        TaskView& task = s.tasks[i];
        task.result = store.result(batch.tasks[i].key);
        s.repeated += std::max(0, task.starts - 1);
        if (task.result) {
            task.state = TaskState::done;
            ++s.done;
            s.seconds += task.result->seconds;
            ++s.hosts[task.result->host];
        } else if (task.starts > 0 && Claim(store.claims(), batch.tasks[i].key).is_taken_elsewhere()) {
            task.state = TaskState::running;
            ++s.running;
        } else if (!task.last.task.empty() && task.last.kind == EventKind::failed) {
            task.state = TaskState::failed;
            ++s.failed;
        } else {
            ++s.waiting;
        }
    }
    return s;
}

double seconds_left(Batch const& batch, BatchState const& state)
{
    struct Sum {
        double seconds = 0;
        int tasks = 0;
    };
    std::map<std::string_view, Sum> groups;
    Sum all;
    for (std::size_t i = 0; i < state.tasks.size(); ++i) {
        if (!state.tasks[i].result) continue;
        for (Sum* const sum : {&groups[batch.tasks[i].group], &all}) {
            sum->seconds += state.tasks[i].result->seconds;
            ++sum->tasks;
        }
    }
    double left = 0;
    for (std::size_t i = 0; i < state.tasks.size(); ++i) {
        if (state.tasks[i].result || all.tasks == 0) continue;
        auto const group = groups.find(batch.tasks[i].group);
        Sum const& like = group == groups.end() ? all : group->second;
        left += like.seconds / like.tasks;
    }
    return left;
}

} // namespace viewer::batch
