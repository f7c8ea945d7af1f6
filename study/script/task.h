#pragma once
// What a participant does in a trial.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace study {

enum class Task {
    pair,                ///< which of two?
    pair_with_reference, ///< which of two is more like a third that is shown too?
    two_interval,        ///< "2ifc": which of two intervals has it?
    same_different,      ///< are two the same?
    abx,                 ///< is the third the first or the second?
    oddity,              ///< which of three is not like the others?
    yes_no,              ///< is it there?
    ranking,             ///< put them in order
    rating,              ///< a number of a scale
    magnitude,           ///< any positive number (Stevens)
    adjustment,          ///< set it so that it just fits
    questionnaire,       ///< items of a questionnaire
    free_walk,           ///< go where you like
};

inline constexpr std::array kTasks{Task::pair,         Task::pair_with_reference,
                                   Task::two_interval, Task::same_different,
                                   Task::abx,          Task::oddity,
                                   Task::yes_no,       Task::ranking,
                                   Task::rating,       Task::magnitude,
                                   Task::adjustment,   Task::questionnaire,
                                   Task::free_walk};

/// What a task is, for reader, planner and runner alike.
struct TaskFacts {
    Task task;
    std::string_view name; ///< as in scripts
    std::span<std::string_view const> answers;
    bool takes_pairs, takes_compare;
    bool is_sequential; ///< its stimuli are usually shown one after another
    double response_ms; ///< expected for planning; of ranking for each stimulus
};
TaskFacts const& facts(Task task);

/// Presentation orders of a task as letters of its stimuli ("aab": a, a, then b) and the right answer to each;
/// only of tasks that have one. @param without_noise leaves out those in which there is nothing to find
struct PresentedOrder {
    std::string_view letters, answer;
    bool is_noise;
};
std::vector<PresentedOrder> presented_orders(Task task, bool without_noise);

} // namespace study
