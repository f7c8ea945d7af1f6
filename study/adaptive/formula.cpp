#include "study/adaptive/formula.h"

#include "gi/core/edit_distance.h"
#include "study/numeric/special.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

namespace study {
namespace {

struct Function1 {
    std::string_view name;
    double (*at)(double);
};
constexpr Function1 kOfOne[]{
    {"exp", [](double v) { return std::exp(v); }},   {"log", [](double v) { return std::log(v); }},
    {"log2", [](double v) { return std::log2(v); }}, {"log10", [](double v) { return std::log10(v); }},
    {"sqrt", [](double v) { return std::sqrt(v); }}, {"abs", [](double v) { return std::abs(v); }},
    {"tanh", [](double v) { return std::tanh(v); }}, {"atan", [](double v) { return std::atan(v); }},
    {"erf", [](double v) { return std::erf(v); }},   {"normal", [](double v) { return normal_cdf(v); }},
};
struct Function2 {
    std::string_view name;
    double (*at)(double, double);
};
constexpr Function2 kOfTwo[]{
    {"min", [](double a, double b) { return std::fmin(a, b); }},
    {"max", [](double a, double b) { return std::fmax(a, b); }},
};
constexpr std::size_t kDeepest = 50, kLongest = 1000; // two levels for each parenthesis

template <class Table>
int index_of(Table const& table, std::string_view name)
{
    for (std::size_t i = 0; i < std::size(table); ++i)
        if (table[i].name == name) return int(i);
    return -1;
}

} // namespace

FormulaError::FormulaError(int column_, std::string problem_, std::string why_, std::string suggestion_)
    : std::invalid_argument(problem_ + " (" + why_ + ") " + suggestion_),
      column(column_),
      problem(std::move(problem_)),
      why(std::move(why_)),
      suggestion(std::move(suggestion_))
{
}

/// sum: product {(+|-) product}; product: signed {(*|/) signed}; signed: [-] power; power: atom [^ signed].
class FormulaParser {
public:
    explicit FormulaParser(Formula& f) : f_(f), text_(f.text_), is_used_(f.names_.size()) {}

    void parse(std::size_t needed)
    {
        if (text_.size() > kLongest)
            fail("a formula of more than 1000 characters", "formulas are short", "shorten it");
        sum();
        if (skip() < text_.size())
            fail("'" + rest() + "' after the formula", "an operator is missing", "write a * b");
        for (std::size_t i = 0; i < needed; ++i)
            if (!is_used_[i])
                fail_at(
                    0, "a formula without " + f_.names_[i], "it would not depend on it",
                    "such as guess + (1 - guess - lapse) * normal((x - threshold) / slope), or (threshold - x) "
                    "where higher levels are harder");
    }

private:
    using Op = Formula::Op;

    [[noreturn]] void fail_at(std::size_t at, std::string problem, std::string why, std::string suggestion) const
    {
        throw FormulaError(int(at) + 1, std::move(problem), std::move(why), std::move(suggestion));
    }
    [[noreturn]] void fail(std::string problem, std::string why, std::string suggestion) const
    {
        fail_at(std::min(at_, text_.size()), std::move(problem), std::move(why), std::move(suggestion));
    }
    std::string rest() const { return text_.substr(at_, 16); }
    std::size_t skip()
    {
        while (at_ < text_.size() && text_[at_] == ' ') ++at_;
        return at_;
    }
    bool take(char c)
    {
        if (skip() >= text_.size() || text_[at_] != c) return false;
        ++at_;
        return true;
    }
    void put(Op op, double number = 0, int index = 0) { f_.steps_.push_back({op, number, index}); }

    void sum()
    {
        if (++depth_ > kDeepest) fail("a formula nested deeper than 25", "it is too complex", "simplify it");
        product();
        for (;;) {
            Op const op = take('+') ? Op::add : take('-') ? Op::subtract : Op::number;
            if (op == Op::number) break;
            product();
            put(op);
        }
        --depth_;
    }
    void product()
    {
        signed_power();
        for (;;) {
            Op const op = take('*') ? Op::multiply : take('/') ? Op::divide : Op::number;
            if (op == Op::number) return;
            signed_power();
            put(op);
        }
    }
    void signed_power()
    {
        if (++depth_ > kDeepest) fail("a formula nested deeper than 25", "it is too complex", "simplify it");
        if (take('-')) {
            signed_power();
            put(Op::negate);
        } else {
            atom();
            if (take('^')) {
                signed_power();
                put(Op::power);
            }
        }
        --depth_;
    }
    void close()
    {
        if (!take(')')) fail("a '(' that is not closed", "the formula ends or goes on without ')'", "add )");
    }
    void atom()
    {
        if (take('(')) {
            sum();
            return close();
        }
        if (skip() >= text_.size()) fail("the formula ends here", "a number or name is missing", "complete it");
        char const c = text_[at_];
        if ((c >= '0' && c <= '9') || c == '.') return number();
        if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')) return name();
        fail("'" + rest() + "'", "a number, a name or '(' is needed here", "write a formula of x and threshold");
    }
    void number()
    {
        double v = 0;
        auto const [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), v);
        if (error != std::errc()) fail("'" + rest() + "' is no number", "it cannot be read", "write 1 or 0.5");
        at_ = std::size_t(end - text_.data());
        put(Op::number, v);
    }
    void name()
    {
        std::size_t const begin = at_;
        auto const is_letter = [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
        };
        while (at_ < text_.size() && is_letter(text_[at_])) ++at_;
        std::string const word = text_.substr(begin, at_ - begin);
        if (word == "pi") return put(Op::number, std::numbers::pi);
        for (std::size_t i = 0; i < f_.names_.size(); ++i)
            if (f_.names_[i] == word) {
                is_used_[i] = true;
                return put(Op::variable, 0, int(i));
            }
        int const one = index_of(kOfOne, word), two = index_of(kOfTwo, word);
        if (one < 0 && two < 0) unknown(begin, word);
        if (!take('(')) fail("'" + word + "' without '('", "it is a function", "write " + word + "(x)");
        sum();
        if (two >= 0) {
            if (!take(',')) fail("'" + word + "' of one value", "it needs two", "write " + word + "(x, 1)");
            sum();
        }
        close();
        put(two >= 0 ? Op::call2 : Op::call1, 0, std::max(one, two));
    }
    [[noreturn]] void unknown(std::size_t begin, std::string const& word) const
    {
        std::vector<std::string> known = f_.names_;
        known.emplace_back("pi");
        for (Function1 const& f : kOfOne) known.emplace_back(f.name);
        for (Function2 const& f : kOfTwo) known.emplace_back(f.name);
        fail_at(begin, "'" + word.substr(0, 64) + "' in a formula", "there is no value or function of that name",
                gi::suggest(word, known));
    }

    Formula& f_;
    std::string const& text_;
    std::size_t at_ = 0, depth_ = 0;
    std::vector<bool> is_used_;
};

Formula::Formula(std::string text, std::vector<std::string> names, std::size_t needed)
    : text_(std::move(text)), names_(std::move(names))
{
    FormulaParser(*this).parse(needed);
}

Formula Formula::psychometric(std::string text)
{
    return {std::move(text), {kPsychometricValues.begin(), kPsychometricValues.end()}, 2};
}

bool Formula::uses(std::size_t name) const
{
    return std::any_of(steps_.begin(), steps_.end(),
                       [&](Step const& s) { return s.op == Op::variable && s.index == int(name); });
}

double Formula::operator()(std::span<double const> values) const
{
    std::vector<double> stack;
    stack.reserve(16);
    auto const pop = [&] {
        double const v = stack.back();
        stack.pop_back();
        return v;
    };
    for (Step const& s : steps_) {
        if (s.op == Op::number || s.op == Op::variable) {
            stack.push_back(s.op == Op::number ? s.number : values[std::size_t(s.index)]);
            continue;
        }
        double const b = pop();
        switch (s.op) {
        case Op::negate:
            stack.push_back(-b);
            break;
        case Op::call1:
            stack.push_back(kOfOne[s.index].at(b));
            break;
        case Op::add:
            stack.push_back(pop() + b);
            break;
        case Op::subtract:
            stack.push_back(pop() - b);
            break;
        case Op::multiply:
            stack.push_back(pop() * b);
            break;
        case Op::divide:
            stack.push_back(pop() / b);
            break;
        case Op::power:
            stack.push_back(std::pow(pop(), b));
            break;
        default:
            stack.push_back(kOfTwo[s.index].at(pop(), b));
        }
    }
    return stack.back();
}

} // namespace study
