#include "chain_binding.hpp"

#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <new>
#include <stdexcept>
#include <vector>

namespace nb = nanobind;

namespace hyst {
namespace {

template <class Value>
Value of(nb::handle stage, const char *name) {
    return nb::cast<Value>(stage.attr(name));
}

}  // namespace

kinds::Given as_given(nb::handle stage) {
    kinds::Given given;
    given.kind = of<std::string>(stage, "kind");
    given.form = of<std::string>(stage, "form");
    given.constants = of<std::vector<double>>(stage, "constants");
    given.fixed = of<std::map<std::string, std::vector<double>>>(stage, "fixed");
    given.choices = of<std::map<std::string, std::size_t>>(stage, "choices");
    const nb::object dt = stage.attr("dt");
    given.dt = dt.is_none() ? 0.0 : nb::cast<double>(dt);
    for (nb::handle each : stage.attr("inside")) given.inside.push_back(as_given(each));
    return given;
}

namespace {

void construct(Chain *chain, nb::iterable stages) {
    std::vector<kinds::Given> given;
    for (nb::handle stage : stages) given.push_back(as_given(stage));
    try {
        new (chain) Chain(given);
    } catch (const std::out_of_range &) {
        throw std::invalid_argument("a stage lacks a choice or a fixed constant of its kind");
    }
}

nb::dict told_of(const kinds::Kind &kind, const kinds::Constants &made, std::size_t state_length) {
    nb::dict numbers, tables, choices, offers;
    for (const kinds::Constant &each : made.all()) {
        const nb::str name(each.name.c_str());
        if (each.is_table) {
            tables[name] = nb::tuple(nb::cast(each.values));
        } else {
            numbers[name] = each.values[0];
        }
        offers[name] = nb::make_tuple(static_cast<int>(each.offer.rule), each.offer.meaning);
    }
    for (const auto &each : made.choices()) choices[nb::str(each.first.c_str())] = each.second;
    nb::dict told;
    told["kind"] = kind.name;
    told["numbers"] = numbers;
    told["tables"] = tables;
    told["choices"] = choices;
    told["form"] = made.form;
    told["state_length"] = state_length;
    told["offers"] = offers;
    told["feeds_through"] = made.feeds_through;
    told["header"] = kind.written.header;
    told["structure"] = made.structure;
    told["call"] = kind.written.call;
    nb::list inside;
    for (std::size_t i = 0; i < made.inside.size(); ++i) {
        const kinds::Inside &each = made.inside[i];
        inside.append(told_of(*each.kind, each.constants, hyst_stage_state_length(&made.stages[i])));
    }
    told["inside"] = inside;
    return told;
}

// What the core is given of stage i, in the order of its structure; and how C writes it.
nb::dict constants(const Chain &chain, std::size_t i) {
    if (i >= chain.stages().size()) throw nb::index_error("the chain has no such stage");
    const Stage &stage = chain.stages()[i];
    return told_of(*stage.kind, chain.constants(i), stage.state_length());
}

std::vector<std::string> names_of_kinds() {
    std::vector<std::string> names;
    for (const kinds::Kind *each : kinds::all_kinds()) names.emplace_back(each->name);
    return names;
}

}  // namespace

void bind_stages(nb::module_ &module, nb::class_<Chain> &chain) {
    module.def("kinds", &names_of_kinds);
    chain.def("__init__", &construct, nb::arg("stages"))
        .def("__len__", [](const Chain &self) { return self.stages().size(); })
        .def("constants", &constants, nb::arg("i"));
}

}  // namespace hyst
