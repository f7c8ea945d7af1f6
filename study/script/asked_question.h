#pragma once
// Questions about the participant that a script asks, such as age, and the check of their answers.

#include <string>
#include <vector>

namespace study {

enum class AskedType { text, number, choice };

/// A question about the participant, before the first trial of the first session.
struct AskedQuestion {
    std::string id;   ///< name in records
    std::string text; ///< as shown; the id if the script gives none
    AskedType type = AskedType::text;
    double low = 0, high = 0;         ///< of a number
    bool is_whole = false;            ///< of a number
    std::vector<std::string> choices; ///< at least two
};

/// Why the text is no answer: "write a whole number from 18 to 99"; empty = it is one. Choices are answered by
/// their text. An empty text is always allowed: the participant does not want to say.
std::string flaw_of_answer(AskedQuestion const& question, std::string const& answer);

} // namespace study
