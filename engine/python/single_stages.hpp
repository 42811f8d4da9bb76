// Stages as the module in single precision is told them.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "../kinds/kind.hpp"

namespace hyst::single {

using Numbers = std::map<std::string, double>;
using Tables = std::map<std::string, std::vector<double>>;
using Choices = std::map<std::string, std::size_t>;
// Kind, form, numbers, tables, choices of a stage, as the engine in double has derived them.
using Description = std::tuple<std::string, std::string, Numbers, Tables, Choices>;

inline kinds::Constants rounded(const Description &description) {
    const auto &[kind, form, numbers, tables, choices] = description;
    kinds::Constants made;
    made.form = form;
    for (const auto &[name, value] : numbers) {
        made.number(name, static_cast<float>(value), kinds::not_offered);
    }
    for (const auto &[name, values] : tables) {
        made.table(name, {values.begin(), values.end()}, kinds::not_offered);
    }
    for (const auto &[name, choice] : choices) made.choose(name, choice);
    return made;
}

}  // namespace hyst::single
