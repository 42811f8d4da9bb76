#include "chain.hpp"

#include <utility>

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
    }
    return 0;
}

}  // namespace hyst
