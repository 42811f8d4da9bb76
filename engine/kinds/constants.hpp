// From the constants of an operator to those of the core, in the number type of this translation unit.
//
// Files of engine/kinds are compiled once for every number type: hyst_real of hyst/real.h. Where two of
// them meet in one program, the other one names a namespace of its own, -DHYST_KINDS=name.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "hyst/chain.h"
#include "hyst/real.h"

#ifndef HYST_KINDS
#define HYST_KINDS kinds
#endif

namespace hyst {
namespace HYST_KINDS {

using Reals = std::vector<hyst_real>;

// What an operator says of a stage; hyst.operators.stage.Stage in Python.
struct Given {
    std::string kind, form;
    Reals constants;                                   // in the order of Operator.parameters()
    std::map<std::string, std::vector<double>> fixed;  // constants that are no parameters
    std::map<std::string, std::size_t> choices;
    double dt;  // seconds; 0 where any will do
    // Stages inside this one, whose constants come first among its own.
    std::vector<Given> inside = {};

    // `count` of the constants from place `first` on.
    Reals part(std::size_t first, std::size_t count) const {
        require(first + count <= constants.size());
        return {constants.begin() + static_cast<std::ptrdiff_t>(first),
                constants.begin() + static_cast<std::ptrdiff_t>(first + count)};
    }
    // Constants that are no parameters.
    Reals kept(const std::string &name) const {
        const std::vector<double> &values = fixed.at(name);
        return {values.begin(), values.end()};
    }
    void require(bool fits) const {
        if (fits) return;
        throw std::invalid_argument("a stage of kind '" + kind + "' has " +
                                    std::to_string(constants.size()) +
                                    " constants, which do not fit its sizes");
    }
};

// Who may change a constant of an exported model, and what it is; the numbers are those of hyst_fmu.h.
// The memory does not depend on weights, gains and memoryless maps: they may change at any time. It
// belongs to thresholds and to what widens them, which may change until initialization ends. What must
// satisfy conditions that no single entry shows (stability, monotony) is not offered.
struct Offer {
    enum Rule { constant, fixed, threshold, tunable } rule;
    const char *meaning;
};
constexpr Offer not_offered{Offer::constant, ""};

// A constant of the core by its place in the core's structure.
struct Constant {
    std::string name;
    Reals values;
    bool is_table;
    Offer offer;
};

struct Inside;

// What the core needs of one stage, and the memory that its structure points into.
class Constants {
public:
    void number(std::string name, hyst_real value, Offer offer) {
        all_.push_back({std::move(name), {value}, false, offer});
    }
    void table(std::string name, Reals values, Offer offer) {
        all_.push_back({std::move(name), std::move(values), true, offer});
    }
    // A size that no table has, or what is switched on (1) or off (0).
    void choose(std::string name, std::size_t choice) {
        choices_.emplace_back(std::move(name), choice);
    }

    hyst_real number(const char *name) const { return find(name).values[0]; }
    const hyst_real *table(const char *name) const { return find(name).values.data(); }
    std::size_t size(const char *name) const { return find(name).values.size(); }
    std::size_t choice(const char *name) const {
        for (const auto &each : choices_) {
            if (each.first == name) return each.second;
        }
        throw std::invalid_argument(std::string("a stage has no choice '") + name + "'");
    }
    bool has_choice(const char *name) const {
        for (const auto &each : choices_) {
            if (each.first == name) return true;
        }
        return false;
    }
    int is(const char *name) const { return static_cast<int>(choice(name)); }

    const std::vector<Constant> &all() const { return all_; }
    // All constants, to be changed; whoever changes a number fills the structure anew, which stays where
    // it is, as the values do.
    std::vector<Constant> &changeable() { return all_; }
    std::size_t model_size() const { return model_size_; }
    const std::vector<std::pair<std::string, std::size_t>> &choices() const { return choices_; }

    std::string form;       // which curve or function: the enumerator of the core, or ""
    const char *structure = "";    // the C that makes the structure; see kind.hpp
    bool feeds_through = true;     // whether the output of a sample depends on its input
    std::vector<Inside> inside;    // stages inside this one; see kind.hpp
    std::vector<hyst_stage> stages;  // the same as the core has them, once they are filled

    // Keeps a structure of the core as long as its constants; made again, it stays where it is.
    template <class Model>
    const void *hold(const Model &model) {
        if (model_.use_count() == 1) {
            return new (model_.get()) Model(model);
        }
        constexpr std::align_val_t alignment{alignof(Model)};
        model_size_ = sizeof(Model);
        model_ = {::operator new(sizeof(Model), alignment),
                  [](void *place) { ::operator delete(place, std::align_val_t{alignof(Model)}); }};
        return new (model_.get()) Model(model);
    }

private:
    const Constant &find(const char *name) const {
        for (const Constant &each : all_) {
            if (each.name == name) return each;
        }
        throw std::invalid_argument(std::string("a stage has no constant '") + name + "'");
    }

    std::vector<Constant> all_;
    std::vector<std::pair<std::string, std::size_t>> choices_;
    std::shared_ptr<void> model_;
    std::size_t model_size_ = 0;
};

}  // namespace HYST_KINDS
}  // namespace hyst
