#include "chain.hpp"

#include <stdexcept>
#include <utility>

#include "masing_jacobian.hpp"

namespace hyst {

const double *Chain::keep(std::vector<double> values) {
    constants_.push_back(std::move(values));
    return constants_.back().data();
}

void Chain::add_affine(double gain, double offset) {
    hyst_stage stage{};
    stage.kind = HYST_AFFINE;
    stage.as.affine = {gain, offset};
    stages_.push_back(stage);
}

void Chain::add_play(double r) {
    hyst_stage stage{};
    stage.kind = HYST_PLAY;
    stage.as.r = r;
    stages_.push_back(stage);
}

void Chain::add_stop(double r) {
    add_play(r);
    stages_.back().kind = HYST_STOP;
}

void Chain::add_dead_zone(std::vector<double> weights, std::vector<double> thresholds,
                          bool by_direction) {
    hyst_stage stage{};
    stage.kind = by_direction ? HYST_DIRECTION_DEAD_ZONE : HYST_DEAD_ZONE;
    const std::size_t count = weights.size();
    const double *weight = keep(std::move(weights));
    stage.as.dead_zone = {count, weight, keep(std::move(thresholds))};
    stages_.push_back(stage);
}

void Chain::add_pi(double p0, std::vector<double> p, std::vector<double> r) {
    hyst_stage stage{};
    stage.kind = HYST_PI;
    const std::size_t count = p.size();
    const double *weight = keep(std::move(p));
    stage.as.pi = {count, p0, weight, keep(std::move(r))};
    stages_.push_back(stage);
}

void Chain::add_rate_dependent_pi(double p0, std::vector<double> p, std::vector<double> r,
                                  const RateCurve &curve, double dt) {
    add_pi(p0, std::move(p), std::move(r));
    hyst_stage stage{};
    stage.kind = HYST_RATE_DEPENDENT_PI;
    stage.as.rate_dependent_pi.pi = stages_.back().as.pi;
    stage.as.rate_dependent_pi.growth = curve.beta / dt;
    // The core's curve is over the change of the input in one sample, x dt.
    std::vector<double> powers = curve.powers, slopes = curve.slopes, knees = curve.knees;
    double scale = dt;
    for (double &power : powers) power /= scale *= dt;
    for (double &slope : slopes) slope /= dt;
    for (double &knee : knees) knee *= dt;
    stage.as.rate_dependent_pi.powers = powers.size();
    stage.as.rate_dependent_pi.power = keep(std::move(powers));
    const std::size_t ramps = slopes.size();
    const double *slope = keep(std::move(slopes));
    stage.as.rate_dependent_pi.ramps = {ramps, slope, keep(std::move(knees))};
    stages_.back() = stage;
    dts_.resize(stages_.size(), 0.0);
    dts_.back() = dt;
}

void Chain::add_state_space(std::size_t delay, std::vector<double> a, std::vector<double> b,
                            std::vector<double> c, double d) {
    const std::size_t order = b.size();
    if (order > HYST_LARGEST_ORDER || a.size() != order * order || c.size() != order) {
        throw std::invalid_argument("the matrices of the state space do not fit each other");
    }
    hyst_stage stage{};
    stage.kind = HYST_STATE_SPACE;
    const double *columns = keep(std::move(a)), *input = keep(std::move(b));
    stage.as.state_space = {order, delay, columns, input, keep(std::move(c)), d};
    stages_.push_back(stage);
}

void Chain::add_sections(std::vector<double> coefficients) {
    if (coefficients.size() % 5 != 0) throw std::invalid_argument("give five numbers a section");
    hyst_stage stage{};
    stage.kind = HYST_SECTIONS;
    const std::size_t count = coefficients.size() / 5;
    stage.as.sections = {count, keep(std::move(coefficients))};
    stages_.push_back(stage);
}

std::size_t Chain::state_length() const {
    const hyst_chain chain = view();
    return hyst_chain_state_length(&chain);
}

std::size_t Chain::parameter_count() const {
    std::size_t count = 0;
    for (const hyst_stage &stage : stages_) count += hyst::parameter_count(stage);
    return count;
}

void Chain::run(double *state, const double *u, double *y, std::size_t samples) const {
    const hyst_chain chain = view();
    hyst_chain_run(&chain, state, u, y, samples);
}

std::size_t parameter_count(const hyst_stage &stage) {
    switch (stage.kind) {
    case HYST_AFFINE:
        return 2;
    case HYST_PLAY:
    case HYST_STOP:
        return 1;
    case HYST_DEAD_ZONE:
    case HYST_DIRECTION_DEAD_ZONE:
        return 2 * stage.as.dead_zone.count;
    case HYST_PI:
        return 1 + 2 * stage.as.pi.count;
    case HYST_RATE_DEPENDENT_PI: {
        const hyst_rate_dependent_pi &model = stage.as.rate_dependent_pi;
        return 2 + 2 * model.pi.count + model.powers + model.ramps.count;
    }
    case HYST_STATE_SPACE: {
        const std::size_t order = stage.as.state_space.order;
        return (order + 2) * order + 1;
    }
    case HYST_SECTIONS:
        return 5 * stage.as.sections.count;
    case HYST_MASING:
        return parameter_count(stage.as.masing);
    case HYST_MEMORY_ELEMENT:
        return stage.as.memory_element.function.count;
    }
    return 0;
}

}  // namespace hyst
