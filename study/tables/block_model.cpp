#include "study/tables/block_model.h"

#include "study/tables/events.h"

#include <algorithm>

namespace study {
namespace {

bool is_in_sequence(std::vector<SequenceItem> const& items, int factor)
{
    return std::any_of(items.begin(), items.end(), [&](SequenceItem const& i) {
        return (i.kind == SequenceKind::per && i.index == factor) || is_in_sequence(i.items, factor);
    });
}

bool is_between(Script const& s, int factor)
{
    return std::any_of(s.counterbalances.begin(), s.counterbalances.end(), [&](Counterbalance const& c) {
        return c.factor == factor && c.method == Balance::between;
    });
}

void add_factors(Script const& s, Block const& b, BlockModel& m)
{
    auto const names = factor_columns(s);
    for (std::size_t f = 0; f < s.factors.size(); ++f) {
        bool const is_crossed =
            std::find(b.cross.begin(), b.cross.end(), int(f)) != b.cross.end() ||
            std::any_of(b.nest.begin(), b.nest.end(), [&](Nest const& n) { return n.factor == int(f); });
        bool const differs = is_between(s, int(f));
        bool const is_alone = b.only.size() > f && b.only[f].size() == 1;
        if ((!is_crossed && !differs && !is_in_sequence(s.sequence, int(f))) || is_alone ||
            compared_factor(b) == int(f))
            continue;
        m.factors.push_back(names[f]);
        if (differs) m.between.push_back(names[f]);
    }
}

void add_items(Script const& s, Block const& b, BlockModel& m)
{
    for (auto const& [i, j] : b.pairs->pairs)
        for (int const level : {i, j}) {
            std::string const& name = s.factors[std::size_t(b.pairs->factor)].levels[std::size_t(level)].name;
            if (std::find(m.items.begin(), m.items.end(), name) == m.items.end()) m.items.push_back(name);
        }
}

} // namespace

std::vector<BlockModel> block_models(Script const& script)
{
    std::vector<BlockModel> out;
    for (Block const& b : script.blocks) {
        BlockModel m;
        m.block = b.name;
        m.task = study::facts(b.task).name;
        switch (b.task) {
        case Task::pair:
        case Task::pair_with_reference:
            m.kind = ModelKind::pairs;
            add_items(script, b, m);
            break;
        case Task::rating:
            break;
        case Task::magnitude:
        case Task::adjustment:
            m.is_log = b.task == Task::magnitude || (b.compare && b.compare->scale != Scale::linear);
            break;
        case Task::yes_no:
            m.kind = ModelKind::yes_no;
            break;
        case Task::two_interval:
        case Task::abx:
        case Task::same_different:
            m.kind = ModelKind::detection;
            m.guess = 0.5;
            break;
        case Task::oddity:
            m.kind = ModelKind::detection;
            m.guess = 1.0 / 3;
            break;
        case Task::ranking:
        case Task::questionnaire:
        case Task::free_walk:
            continue;
        }
        if (m.kind == ModelKind::detection || m.kind == ModelKind::yes_no) {
            m.has_level = b.compare && !b.compare->vary.empty();
            m.compares_factor = compared_factor(b) >= 0;
            m.compares_pairs = b.pairs.has_value();
            m.is_log = m.has_level && b.compare->scale != Scale::linear;
        }
        add_factors(script, b, m);
        out.push_back(std::move(m));
    }
    return out;
}

std::string quoted(std::string const& text)
{
    std::string out = "\"";
    for (char const c : text)
        if (c == '"' || c == '\\')
            out += std::string("\\") + c;
        else
            out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    return out + "\"";
}

} // namespace study
