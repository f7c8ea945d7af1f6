#pragma once
// Tasks: what a participant does in a trial.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace study {

enum class Task {
    pair,                ///< which of two?
    pair_with_reference, ///< which of two is more like a third, which is also shown?
    two_interval,        ///< "2ifc": which of two intervals has the signal?
    same_different,      ///< are two the same?
    abx,                 ///< is the third the first or the second?
    oddity,              ///< which of three is not like the others?
    yes_no,              ///< is the signal present?
    ranking,             ///< put them in order
    rating,              ///< a number on a scale
    magnitude,           ///< any positive number (Stevens)
    adjustment,          ///< adjust the setting until it just fits
    questionnaire,       ///< items of a questionnaire
    free_walk,           ///< walk freely
};

inline constexpr std::array kTasks{Task::pair,         Task::pair_with_reference,
                                   Task::two_interval, Task::same_different,
                                   Task::abx,          Task::oddity,
                                   Task::yes_no,       Task::ranking,
                                   Task::rating,       Task::magnitude,
                                   Task::adjustment,   Task::questionnaire,
                                   Task::free_walk};

/// Properties of a task, used by reader, planner and runner.
struct TaskFacts {
    Task task;
    std::string_view name; ///< as in scripts
    std::span<std::string_view const> answers;
    bool takes_pairs, takes_compare;
    bool is_sequential; ///< its stimuli are usually shown one after another
    double response_ms; ///< expected response time for planning; for ranking per stimulus
};
TaskFacts const& facts(Task task);
/// Proportion correct by guessing; 0 where it goes down to the false alarm rate, which is not known before.
double guess_rate(Task task);

/// Presentation orders of a task as letters of its stimuli ("aab": a, a, then b) with the correct answer to each;
/// only for tasks that have one. @param without_noise omits orders in which there is nothing to find
struct PresentedOrder {
    std::string_view letters, answer;
    bool is_noise;
};
std::vector<PresentedOrder> presented_orders(Task task, bool without_noise);

} // namespace study
