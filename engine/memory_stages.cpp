// Stages of a chain with memory of reversals: loading curves and memory elements.
#include <stdexcept>
#include <utility>

#include "chain.hpp"

namespace hyst {
namespace {

// Knots, values and slopes of f(x) = p0 x + sum_i p_i max(x - r_i, 0), from p0 p_1.. r_1..
struct Pieces {
    std::vector<double> knot{0.0}, value{0.0}, slope;

    explicit Pieces(const std::vector<double> &constants) : slope{constants[0]} {
        const std::size_t plays = constants.size() / 2;
        for (std::size_t i = 0; i < plays; ++i) {
            const double p = constants[1 + i], r = constants[1 + plays + i];
            value.push_back(value.back() + slope.back() * (r - knot.back()));
            knot.push_back(r);
            slope.push_back(slope.back() + p);
        }
    }
};

}  // namespace

void Chain::add_masing(hyst_curve_kind curve, std::vector<double> constants, double least_slope,
                       const MasingMemory &memory) {
    hyst_stage stage{};
    stage.kind = HYST_MASING;
    stage.as.masing = {{}, memory.inverse, memory.last_reversal, memory.depth, memory.dead_band};
    hyst_loading_curve &f = stage.as.masing.curve;
    f.kind = curve;
    if (curve == HYST_POWER_LAW) {
        if (constants.size() != 3) throw std::invalid_argument("a power law has c1, c2, c3");
        const double exponent = constants[2] + 1.0;
        f.as.power_law = {constants[0],
                          hyst_power(2.0, constants[2]) * constants[1] / exponent, exponent};
    } else if (curve == HYST_PLAYS) {
        if (constants.size() % 2 == 0) throw std::invalid_argument("give p0, p and r");
        Pieces pieces(constants);
        const std::size_t count = pieces.knot.size();
        const double *knot = keep(std::move(pieces.knot));
        const double *value = keep(std::move(pieces.value));
        f.as.pieces = {count, knot, value, keep(std::move(pieces.slope))};
    } else {
        const std::size_t count = constants.size();
        f.as.polynomial = {count, keep(std::move(constants)), least_slope};
    }
    stages_.push_back(stage);
}

void Chain::add_memory_element(hyst_memory_kind function, std::vector<double> knots,
                               std::vector<double> constants, const Momentum &momentum,
                               double dt) {
    hyst_stage stage{};
    stage.kind = HYST_MEMORY_ELEMENT;
    const std::size_t count = constants.size();
    const double *knot = keep(std::move(knots));
    stage.as.memory_element = {{function, count, knot, keep(std::move(constants))},
                               momentum.inverse,
                               momentum.absolute,
                               momentum.is_reset,
                               momentum.reset_to,
                               dt};
    stages_.push_back(stage);
}

}  // namespace hyst
