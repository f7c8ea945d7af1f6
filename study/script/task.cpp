#include "study/script/task.h"

namespace study {
namespace {

using Answers = std::string_view const[];

constexpr std::string_view kTwo[] = {"first", "second"};
constexpr std::string_view kThree[] = {"first", "second", "third"};
constexpr std::string_view kSame[] = {"same", "different"};
constexpr std::string_view kYesNo[] = {"yes", "no"};
constexpr std::string_view kSlider[] = {"up", "down", "confirm"};
constexpr std::string_view kConfirm[] = {"confirm"};

constexpr TaskFacts kFacts[] = {
    {Task::pair, "pair", kTwo, true, false, false, 1500},
    {Task::pair_with_reference, "pair_with_reference", kTwo, true, false, false, 1500},
    {Task::two_interval, "2ifc", kTwo, false, true, true, 1000},
    {Task::same_different, "same_different", kSame, true, true, false, 1500},
    {Task::abx, "abx", kTwo, true, true, true, 1500},
    {Task::oddity, "oddity", kThree, true, true, false, 2000},
    {Task::yes_no, "yes_no", kYesNo, false, true, true, 1000},
    {Task::ranking, "ranking", kSlider, false, false, false, 4000},
    {Task::rating, "rating", kSlider, false, false, true, 2500},
    {Task::magnitude, "magnitude", kSlider, false, false, true, 4000},
    {Task::adjustment, "adjustment", kSlider, false, true, false, 15000},
    {Task::questionnaire, "questionnaire", kSlider, false, false, true, 0},
    {Task::free_walk, "free_walk", kConfirm, false, false, true, 0},
};

} // namespace

TaskFacts const& facts(Task task) { return kFacts[std::size_t(task)]; }

double guess_rate(Task task)
{
    if (task == Task::oddity) return 1.0 / 3;
    return task == Task::yes_no || task == Task::same_different ? 0 : 0.5;
}

std::vector<PresentedOrder> presented_orders(Task task, bool without_noise)
{
    switch (task) {
    case Task::two_interval:
        return {{"ab", "first", false}, {"ba", "second", false}};
    case Task::same_different:
        if (without_noise) return {{"ab", "different", false}, {"ba", "different", false}};
        return {
            {"ab", "different", false}, {"ba", "different", false}, {"aa", "same", true}, {"bb", "same", true}};
    case Task::abx:
        return {
            {"aba", "first", false}, {"abb", "second", false}, {"bab", "first", false}, {"baa", "second", false}};
    case Task::oddity:
        return {{"abb", "first", false}, {"bab", "second", false}, {"bba", "third", false},
                {"baa", "first", false}, {"aba", "second", false}, {"aab", "third", false}};
    case Task::yes_no:
        if (without_noise) return {{"a", "yes", false}};
        return {{"a", "yes", false}, {"b", "no", true}};
    default:
        return {};
    }
}

} // namespace study
