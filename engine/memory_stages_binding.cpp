#include "memory_stages_binding.hpp"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace hyst {
namespace {

hyst_curve_kind curve_named(const std::string &name) {
    if (name == "power-law") return HYST_POWER_LAW;
    if (name == "plays") return HYST_PLAYS;
    if (name == "polynomial") return HYST_POLYNOMIAL;
    throw std::invalid_argument("unknown loading curve '" + name + "'");
}

hyst_memory_kind memory_named(const std::string &name) {
    if (name == "power-law") return HYST_MEMORY_POWER;
    if (name == "polynomial") return HYST_MEMORY_POLYNOMIAL;
    if (name == "table") return HYST_MEMORY_TABLE;
    throw std::invalid_argument("unknown memory function '" + name + "'");
}

void add_masing(Chain &chain, const std::string &curve, std::vector<double> constants,
                double least_slope, bool inverse, bool last_reversal, std::size_t depth,
                double dead_band) {
    chain.add_masing(curve_named(curve), std::move(constants), least_slope,
                     {inverse, last_reversal, depth, dead_band});
}

void add_memory_element(Chain &chain, const std::string &function, std::vector<double> knots,
                        std::vector<double> constants, bool inverse, bool absolute, bool is_reset,
                        double reset_to, double dt) {
    chain.add_memory_element(memory_named(function), std::move(knots), std::move(constants),
                             {inverse, absolute, is_reset, reset_to}, dt);
}

}  // namespace

void bind_memory_stages(nanobind::class_<Chain> &chain) {
    chain.def("add_masing", &add_masing).def("add_memory_element", &add_memory_element);
}

}  // namespace hyst
