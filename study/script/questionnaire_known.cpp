#include "study/script/questionnaire.h"

#include <array>
#include <initializer_list>

namespace study {
namespace {

using Labels = std::vector<std::string>;

/// Numbers as the papers count items, from 1.
std::vector<int> items(std::initializer_list<int> numbers)
{
    std::vector<int> out;
    for (int const n : numbers) out.push_back(n - 1);
    return out;
}

Questionnaire ssq()
{
    Questionnaire q{"ssq", "Simulator sickness", "How much does each of these affect you right now?", {}, {}, {}};
    int number = 0;
    for (char const* symptom :
         {"General discomfort", "Fatigue", "Headache", "Eyestrain", "Difficulty focusing", "Increased salivation",
          "Sweating", "Nausea", "Difficulty concentrating", "Fullness of head", "Blurred vision",
          "Dizzy (eyes open)", "Dizzy (eyes closed)", "Vertigo", "Stomach awareness", "Burping"})
        q.items.push_back({"ssq" + std::to_string(++number), symptom, 0, 3, 1,
                           Labels{"none", "slight", "moderate", "severe"}, false});
    q.subscales = {{"nausea", items({1, 6, 7, 8, 9, 15, 16}), Combine::sum, 9.54, 0, 0},
                   {"oculomotor", items({1, 2, 3, 4, 5, 9, 11}), Combine::sum, 7.58, 0, 0},
                   {"disorientation", items({5, 8, 10, 11, 12, 13, 14}), Combine::sum, 13.92, 0, 0}};
    Subscale total{"total", {}, Combine::sum, 3.74, 0, 0};
    for (Subscale const& s : q.subscales) total.items.insert(total.items.end(), s.items.begin(), s.items.end());
    q.subscales.push_back(total);
    return q;
}

Questionnaire sus_presence()
{
    Questionnaire q{"sus_presence", "Presence (Slater, Usoh, Steed)", "", {}, {}, {}};
    auto const add = [&](char const* text, char const* low, char const* high) {
        q.items.push_back({"sus" + std::to_string(q.items.size() + 1), text, 1, 7, 1, Labels{low, high}, false});
    };
    add("Please rate your sense of being in the virtual environment, where 7 is your normal experience of being "
        "in a "
        "place. I had a sense of \"being there\" in the virtual environment:",
        "not at all", "very much");
    add("To what extent were there times during the experience when the virtual environment was the reality for "
        "you? "
        "There were times when the virtual environment was the reality for me:",
        "at no time", "almost all the time");
    add("When you think back to the experience, do you think of the virtual environment more as images that you "
        "saw or "
        "more as somewhere that you visited? The virtual environment seems to me to be more like:",
        "images that I saw", "somewhere that I visited");
    add("During the time of the experience, which was the strongest on the whole, your sense of being in the "
        "virtual "
        "environment or of being elsewhere? I had a stronger sense of:",
        "being elsewhere", "being in the virtual environment");
    add("Consider your memory of being in the virtual environment. How similar in terms of the structure of the "
        "memory "
        "is this to that of other places you have been today? I think of the virtual environment as a place in a "
        "way "
        "similar to other places that I have been today:",
        "not at all", "very much so");
    add("During the time of your experience, did you often think to yourself that you were actually in the "
        "virtual "
        "environment? During the experience I often thought that I was really standing in it:",
        "not very often", "very often");
    q.subscales = {{"mean", items({1, 2, 3, 4, 5, 6}), Combine::mean, 1, 0, 0},
                   {"count", items({1, 2, 3, 4, 5, 6}), Combine::count, 1, 0, 6}};
    return q;
}

Questionnaire sus_usability()
{
    Questionnaire q{"sus_usability", "System usability (Brooke)", "", {}, {}, {}};
    bool is_reversed = false;
    for (char const* text :
         {"I think that I would like to use this system frequently.", "I found the system unnecessarily complex.",
          "I thought the system was easy to use.",
          "I think that I would need the support of a technical person to be able to use this "
          "system.",
          "I found the various functions in this system were well integrated.",
          "I thought there was too much inconsistency in this system.",
          "I would imagine that most people would learn to use this system very quickly.",
          "I found the system very cumbersome to use.", "I felt very confident using the system.",
          "I needed to learn a lot of things before I could get going with this system."}) {
        q.items.push_back({"usability" + std::to_string(q.items.size() + 1), text, 1, 5, 1,
                           Labels{"strongly disagree", "strongly agree"}, is_reversed});
        is_reversed = !is_reversed;
    }
    // 2.5 times the sum of what each is above 1
    q.subscales = {{"total", items({1, 2, 3, 4, 5, 6, 7, 8, 9, 10}), Combine::sum, 2.5, -25, 0}};
    return q;
}

Questionnaire ipq()
{
    Questionnaire q{"ipq", "Igroup presence questionnaire", "", {}, {}, {}};
    auto const add = [&](char const* id, char const* text, char const* low, char const* high,
                         bool is_reversed = false) {
        q.items.push_back({id, text, 0, 6, 1, Labels{low, high}, is_reversed});
    };
    char const *const no = "fully disagree", *const yes = "fully agree";
    add("g1", "In the computer generated world I had a sense of \"being there\".", "not at all", "very much");
    add("sp1", "Somehow I felt that the virtual world surrounded me.", no, yes);
    add("sp2", "I felt like I was just perceiving pictures.", no, yes, true);
    add("sp3", "I did not feel present in the virtual space.", "did not feel", "felt present");
    add("sp4", "I had a sense of acting in the virtual space, rather than operating something from outside.", no,
        yes);
    add("sp5", "I felt present in the virtual space.", no, yes);
    add("inv1",
        "How aware were you of the real world surrounding while navigating in the virtual world (sounds, room "
        "temperature, other people, etc.)?",
        "extremely aware", "not aware at all");
    add("inv2", "I was not aware of my real environment.", no, yes);
    add("inv3", "I still paid attention to the real environment.", no, yes, true);
    add("inv4", "I was completely captivated by the virtual world.", no, yes);
    add("real1", "How real did the virtual world seem to you?", "completely real", "not real at all", true);
    add("real2",
        "How much did your experience in the virtual environment seem consistent with your real world experience?",
        "not consistent", "very consistent");
    add("real3", "How real did the virtual world seem to you?", "about as real as an imagined world",
        "indistinguishable from the real world");
    add("real4", "The virtual world seemed more realistic than the real world.", no, yes);
    q.subscales = {{"general", items({1}), Combine::mean, 1, 0, 0},
                   {"spatial", items({2, 3, 4, 5, 6}), Combine::mean, 1, 0, 0},
                   {"involvement", items({7, 8, 9, 10}), Combine::mean, 1, 0, 0},
                   {"realism", items({11, 12, 13, 14}), Combine::mean, 1, 0, 0}};
    return q;
}

Questionnaire nasa_tlx()
{
    Questionnaire q{"nasa_tlx", "Task load index", "", {}, {}, {}};
    auto const add = [&](char const* id, char const* text, char const* low, char const* high) {
        q.items.push_back({id, text, 0, 100, 5, Labels{low, high}, false});
    };
    add("mental", "How mentally demanding was the task?", "very low", "very high");
    add("physical", "How physically demanding was the task?", "very low", "very high");
    add("temporal", "How hurried or rushed was the pace of the task?", "very low", "very high");
    add("performance", "How successful were you in accomplishing what you were asked to do?", "perfect",
        "failure");
    add("effort", "How hard did you have to work to accomplish your level of performance?", "very low",
        "very high");
    add("frustration", "How insecure, discouraged, irritated, stressed, and annoyed were you?", "very low",
        "very high");
    q.subscales = {{"raw", items({1, 2, 3, 4, 5, 6}), Combine::mean, 1, 0, 0}};
    return q;
}

} // namespace

std::span<Questionnaire const> known_questionnaires()
{
    static std::array const known{ssq(), sus_presence(), sus_usability(), ipq(), nasa_tlx()};
    return known;
}

} // namespace study
